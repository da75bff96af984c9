import tomllib
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from murkscan.calibrate import Chessboard
from murkscan.calibrate.adjust.observations import index_of
from murkscan.calibrate.adjust.parameters import INTRINSICS
from murkscan.errors import Degenerate, FormatError, InputError, MissingResult, NotEnoughData
from murkscan.io.images import write_image
from murkscan.io.rig_toml import load_rig, save_rig
from murkscan.optics import back_project, project
from murkscan.survey.calibrate_port import Measured, PortKnowledge, calibrate_port_from_photos
from murkscan.types.camera import Camera
from murkscan.types.port import FlatPort, Layer
from murkscan.types.pose import Pose
from murkscan.types.rig import Rig
from murkscan.types.rig_covariance import RigCovariance
from murkscan.types.water import Water

from ..calibrate.boards import rotation

BOARD = Chessboard(9, 6, 0.03)
PORT = FlatPort(np.array([0.03, 0.0, np.sqrt(1 - 0.03**2)]), 0.03, (Layer(0.008, 1.49),))
LENS = Camera((480, 360), (360.0, 360.0), (239.5, 179.5), port=PORT)
KNOWN = RigCovariance(INTRINSICS, np.diag([0.4, 0.4, 0.4, 0.4, *[1e-3] * 5]) ** 2)
RIG = Rig(LENS, water=Water(20.0, 0.0), covariance=KNOWN)
TILTS = [(25, 0), (-25, 5), (0, 30), (5, -30), (18, 20), (-20, -20), (20, -22), (-15, 25)]


@cache
def rays_through_port(number):
    """Trace number × number rays of each pixel, which all photos share."""
    width, height = LENS.size
    v, u = np.mgrid[: number * height, : number * width]
    pixels = (np.stack([u.ravel(), v.ravel()], axis=1) + 0.5) / number - 0.5
    return back_project(LENS, pixels, index_of(RIG))


@cache
def render(camera_from_board):
    """Photograph the board through the port: the level of each pixel's square, of 3 x 3 rays."""
    width, height = LENS.size
    rays = rays_through_port(3)
    normal, middle = camera_from_board.rotation[:, 2], camera_from_board.translation
    reach = ((middle - rays.origins) @ normal) / (rays.directions @ normal)
    points = camera_from_board.inverse() @ (rays.origins + reach[:, None] * rays.directions)
    x, y, _ = points.T / BOARD.square
    inside = (x > -1) & (x < BOARD.columns) & (y > -1) & (y < BOARD.rows)
    dark = inside & ((np.floor(x) + np.floor(y)) % 2 == 0)
    level = np.where(dark, 30.0, 200.0).reshape(height, 3, width, 3).mean(axis=(1, 3))
    return np.repeat(level[:, :, None], 3, axis=2).astype(np.uint8)


@cache
def hold(tilt, number, depths):
    turned = rotation(*tilt, 0)
    depth = depths[number % len(depths)]
    aside = [(0, 0), (0.05, 0.04), (-0.05, 0.04), (0.05, -0.04), (-0.05, -0.04)][number % 5]
    place = np.array([aside[0] * depth / 0.47, aside[1] * depth / 0.47, depth])
    return Pose(turned, place - turned @ BOARD.points().mean(axis=0))


def photograph(folder, depths=(0.47, 0.62, 0.85)):
    for number, tilt in enumerate(TILTS):
        write_image(folder / f"photo{number}.png", render(hold(tilt, number, depths)))
    return folder


@pytest.fixture(scope="module")
def photos(tmp_path_factory):
    return photograph(tmp_path_factory.mktemp("wet"))


@pytest.fixture
def rig(tmp_path):
    """The rig file of one who measured the port with a ruler."""
    path = tmp_path / "rig.toml"
    port = replace(PORT, normal=np.array([0.0, 0.0, 1.0]), distance=0.032)
    save_rig(path, replace(RIG, camera=replace(LENS, port=port)))
    return path


def test_a_tilted_port_is_found_and_written_with_its_covariance(photos, rig):
    result = calibrate_port_from_photos(photos, BOARD, rig)
    found = load_rig(rig)
    names = ["camera.port.normal[0]", "camera.port.normal[1]", "camera.port.distance"]
    sigma = found.covariance.select(names).sigma
    error = np.array(
        [
            *(found.camera.port.normal - PORT.normal)[:2],
            found.camera.port.distance - PORT.distance,
        ]
    )
    # Three errors within 3.5 of their deviations, which are small enough to be worth something.
    assert np.all(np.abs(error) < 3.5 * sigma)
    assert np.all(sigma < [0.01, 0.01, 3e-3])
    assert result.num_photos == len(TILTS)
    record = tomllib.loads(rig.read_text("utf-8"))["calibration"]["port"]
    assert record["views"] == len(TILTS)
    assert "8 photos are few" in record["verdict"]
    drawn = list((rig.parent / "calibrate" / "port").glob("*.found.jpg"))
    assert len(drawn) == len(TILTS)


def test_the_page_shows_each_parameter_the_verdict_and_the_photos(photos, rig):
    result = calibrate_port_from_photos(photos, BOARD, rig)
    page = result.page.read_text("utf-8")
    assert result.page.parent == result.pictures
    for words in ("port&#39;s distance", "8 photos are few", "Leaving out one photo", "± 1σ"):
        assert words in page
    for picture in result.pictures.glob("*.found.jpg"):
        assert picture.name in page


def test_done_again_it_says_the_same(photos, rig):
    """Photos that were counted already are not counted twice."""
    calibrate_port_from_photos(photos, BOARD, rig)
    first = load_rig(rig)
    calibrate_port_from_photos(photos, BOARD, rig)
    second = load_rig(rig)
    np.testing.assert_allclose(second.covariance.sigma, first.covariance.sigma, rtol=1e-3)
    assert second.camera.focal_length == pytest.approx(first.camera.focal_length, abs=1e-3)


def test_other_water_needs_no_other_calibration(photos, rig):
    """The index is considered: in other water it is another one, the rest stays."""
    calibrate_port_from_photos(photos, BOARD, rig)
    text = rig.read_text("utf-8")
    assert "water.index" in load_rig(rig).covariance.names
    place = text.index("[water]")
    sea = text[place:].replace("salinity_psu = 0.0", "salinity_psu = 35.0", 1)
    rig.write_text(text[:place] + sea, "utf-8")
    sea = load_rig(rig)
    assert sea.water.salinity_psu == 35.0
    assert "water.index" not in sea.covariance.names
    assert "camera.port.distance" in sea.covariance.names


def test_an_edited_camera_has_no_covariance_any_more(photos, rig):
    calibrate_port_from_photos(photos, BOARD, rig)
    camera = load_rig(rig).camera
    old = f"{camera.principal_point[0]:.9f}".rstrip("0")
    text = rig.read_text("utf-8").replace(f"principal_point = [{old}", "principal_point = [239.0")
    rig.write_text(text, "utf-8")
    assert load_rig(rig).camera.principal_point[0] == 239.0
    assert load_rig(rig).covariance.names == ()


def test_the_index_of_the_water_is_found_from_the_board_s_size(photos, rig):
    """Salt forgotten: fresh water photographed, 35 PSU in the file."""
    rig.write_text(rig.read_text("utf-8").replace("salinity_psu = 0.0", "salinity_psu = 35.0"))
    knowledge = PortKnowledge(distance=Measured(0.030, 0.0005), is_index_free=True)
    calibrate_port_from_photos(photos, BOARD, rig, knowledge=knowledge)
    found = load_rig(rig)
    assert found.water.index is not None
    sigma = found.covariance.select(["water.index"]).sigma[0]
    assert sigma < 5e-3
    assert found.water.index == pytest.approx(index_of(RIG), abs=3.5 * sigma)


def test_a_camera_that_is_free_too_needs_the_port_s_distance(photos, rig):
    with pytest.raises(
        Degenerate, match=r"do not determine every parameter.*--distance-mm"
    ) as told:
        calibrate_port_from_photos(photos, BOARD, rig, knowledge=PortKnowledge(is_camera_free=True))
    assert "port's distance" in str(told.value) or "focal length" in str(told.value)


@pytest.mark.parametrize(
    ("old", "new", "error", "says"),
    [
        ("distance_mm = 32.0", "distance_mm = 0.032", InputError, "in millimetres"),
        ("salinity_psu = 0.0", "salinity_psu = 350.0", FormatError, "water.salinity_psu"),
        ("[water]\ntemperature_c = 20.0\nsalinity_psu = 0.0\ndepth_m = 0.0\n", "",
         MissingResult, r"no \[water\] yet"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_told_from_what_was_meant(photos, rig, old, new, error, says):
    text = rig.read_text("utf-8")
    assert old in text
    rig.write_text(text.replace(old, new), "utf-8")
    before = rig.read_bytes()
    with pytest.raises(error, match=says):
        calibrate_port_from_photos(photos, BOARD, rig)
    assert rig.read_bytes() == before


def test_boards_at_one_distance_are_told_and_a_half_one_is_used(tmp_path, rig):
    folder = tmp_path / "wet"
    folder.mkdir()
    photograph(folder, depths=(0.5,))
    half = render(hold(TILTS[0], 0, (0.47,)) @ Pose(np.eye(3), np.array([0.2, 0.0, 0.0])))
    write_image(folder / "photo9.png", half)
    result = calibrate_port_from_photos(folder, BOARD, rig)
    cut = {s.name: len(s.corners) for s in result.calibration.sightings}["photo9.png"]
    assert 12 <= cut < BOARD.num_corners
    assert "add photos nearer and farther" in str(result.verdict)


def test_boards_that_face_the_camera_are_refused(tmp_path, rig):
    folder = tmp_path / "wet"
    folder.mkdir()
    for number in range(5):
        write_image(folder / f"{number}.png", render(hold((0, 0), number, (0.47, 0.55, 0.65))))
    with pytest.raises(Degenerate, match="face the camera straight on"):
        calibrate_port_from_photos(folder, BOARD, rig)


def test_too_few_boards_are_refused_with_counts(photos, tmp_path, rig):
    folder = tmp_path / "few"
    folder.mkdir()
    for number in range(3):
        (folder / f"{number}.png").write_bytes((photos / f"photo{number}.png").read_bytes())
    with pytest.raises(NotEnoughData, match="found it in 3 of 3"):
        calibrate_port_from_photos(folder, BOARD, rig)


def test_the_boards_are_where_the_test_holds_them():
    seen = project(LENS, hold(TILTS[0], 0, (0.47,)) @ BOARD.points(), index_of(RIG))
    assert np.all((seen > 0) & (seen < np.array(LENS.size) - 1))
