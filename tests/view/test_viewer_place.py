"""Places on the page: where a point lies on a ship, and control points that are picked."""

from dataclasses import replace

import numpy as np
import pytest

from murkscan.io.control_points import read_hull_points
from murkscan.types.georeference import Georeference
from murkscan.types.hull import HullFrame
from murkscan.types.pose import Pose
from murkscan.view import model_of_points, render_viewer

from .browser import chromium, open_page, rest

POINTS = np.array([[0.0, 0, 1], [1, 0, 1], [0, 1, 1], [1, 1, 1.2], [0.5, 0.4, 1.1]])
SHIP = HullFrame(0.6, "stern", "waterline")


@pytest.fixture(scope="module")
def placed():
    turn = np.array([[-1.0, 0, 0], [0, 0, -1], [0, -1, 0]])
    pose = Pose(turn, np.array([-25.2, 6.0, 0.5]))
    return Georeference("", "", np.zeros(3), 1.0, pose, np.zeros((6, 6)), SHIP)


@pytest.fixture(scope="module")
def page(tmp_path_factory, placed):
    file = tmp_path_factory.mktemp("place") / "index.html"
    model = replace(model_of_points("ship", POINTS), place=placed)
    file.write_text(render_viewer([model], title="ship"), "utf-8")
    with chromium() as browser:
        page, faults = open_page(browser, file)
        yield page
        assert faults == []


def test_a_point_is_read_by_frame_height_and_side(page, placed):
    page.evaluate("murkscan.update({read: 4})")
    said = page.locator("#reading").inner_text()
    wanted = placed.describe(POINTS[4])
    assert wanted == "frame 42.83, 0.100 m above the waterline, 4.900 m to starboard"
    assert said.startswith(wanted.replace(", ", " · "))
    page.evaluate("murkscan.update({read: null})")


def test_picked_points_are_saved_as_the_table_that_georeference_reads(page, tmp_path):
    page.keyboard.press("1")
    page.keyboard.press("g")
    for point in POINTS[:3]:
        rest(page)
        x, y, *_ = page.evaluate(
            "p => murkscan.stage.project(p.map((x, k) => x - murkscan.model.centre[k]))",
            point.tolist(),
        )
        page.locator("#canvas").click(position={"x": x, "y": y})
    page.get_by_role("button", name="Ship, frames").click()
    for number, (frame, side) in enumerate([("42", "starboard"), ("43,5", "S"), ("42", "stbd")]):
        item = page.locator(".picks li").nth(number)
        for column, value in (("frame", frame), ("height_m", str(number)),
                              ("from_centreline_m", "5"), ("side", side)):  # fmt: skip
            item.locator(f"[data-column={column}]").fill(value)
    page.locator(".picks li").nth(1).locator("[data-column=name]").fill("bolt, upper")
    with page.expect_download() as download:
        page.locator("#tool-control").get_by_role("button", name="Save as CSV").click()
    download.value.save_as(tmp_path / "hull.csv")
    read = read_hull_points(tmp_path / "hull.csv", SHIP)
    assert read.names == ("P1", "bolt  upper", "P3")
    np.testing.assert_allclose(read.places[:, 0], [-25.2, -26.1, -25.2])
    np.testing.assert_allclose(read.places[:, 2], [0, 1, 2])
    np.testing.assert_allclose(read.on_model, POINTS[:3], atol=3e-5)
    assert (read.sigma == 5e-3).all()
    command = page.locator("#tool-control .copy").get_attribute("title")
    assert command == "murkscan georeference OUT --hull hull.csv --frame-spacing-mm D"
    page.keyboard.press("Escape")
    assert not page.evaluate("murkscan.state.picking")
