"""The view stage on small projects, made by hand."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest

from murkscan.errors import Degenerate, FormatError, InputError, MissingResult
from murkscan.io.deviation_files import save_deviation_ply
from murkscan.io.images import read_image
from murkscan.mesh import GridMesh
from murkscan.project import CLOUD, MEASURE, MESH, CloudResult, MeasureResult, MeshResult, Project
from murkscan.survey.compared import compare_models
from murkscan.survey.measured import measurement_files
from murkscan.survey.shown import DEVIATION, load_surface
from murkscan.survey.view import draw_views
from murkscan.types.deviation import Deviation
from murkscan.view import draw_pictures, render_viewer

from ..projects import MERGED, finish, save_cloud
from ..scans import scan_cloud, step


def _bed(x, y):
    """A surface that can lie on itself in one way only."""
    return 0.5 + 0.01 * np.sin(60 * x) * np.cos(50 * y) + 0.05 * x


BED = scan_cloud(_bed, spacing=2e-3)
SHIFT = np.array([2e-3, -1e-3, 1.5e-3])
"""How far a vehicle's log has drifted between two dives [m]."""
SCAN = scan_cloud(step, spacing=4e-3)
LINE = SCAN[SCAN.frame == 3]
"""One profile: without a surface no pictures are drawn, which take seconds."""


def merged(folder, cloud=LINE):
    """Make the project of a merged cloud, with a surface if it has one."""
    project = Project(folder)
    project.save_scan(MERGED)
    mesh = GridMesh().mesh(cloud)
    result = CloudResult(len(cloud), outliers=0)
    made = finish(project, CLOUD, result, make=lambda: save_cloud(project, cloud))
    finish(
        project,
        MESH,
        MeshResult(len(mesh.vertices), len(mesh.faces)),
        inputs={"cloud": made.digest},
        make=lambda: len(mesh.faces) and project.save_mesh(mesh),
    )
    return project, cloud


def shown(project):
    """Give what the page says of its models."""
    return content_of((project.root / "view/index.html").read_text("utf-8"))


def content_of(page):
    return json.loads(re.search(r'id="content">(.*?)</script>', page, re.S)[1])


def measure_deviation(project, cloud, *, name="deviation", of=None):
    """Of the present cloud, or of another one."""
    values = np.where(cloud.points[:, 1] > 0, 1e-3, np.nan)
    deviation = Deviation(values, np.zeros_like(cloud.points), np.zeros(len(cloud)))

    rows, sigma = np.arange(len(cloud)), np.zeros(len(cloud))

    def save():
        with measurement_files(project, name).making(f"{name}.ply") as path:
            save_deviation_ply(path, cloud.points, deviation, sigma, rows)

    inputs = {"cloud": of or project.finished(CLOUD).digest}
    finish(project, MEASURE, MeasureResult("deviation"), inputs=inputs, make=save, label=name)


def test_a_merged_cloud_gets_pictures_and_a_page(tmp_path, monkeypatch):
    monkeypatch.setattr("murkscan.survey.view.draw_pictures", draw_pictures)  # as large as they are
    project, cloud = merged(tmp_path / "both", SCAN)
    result = draw_views(project)
    assert (len(result.pictures), result.points) == (9, len(cloud))
    assert read_image(project.root / "view/front.png").shape[:2] == (960, 1280)
    content = shown(project)
    assert content["title"] == "both"
    assert content["pictures"] == "pictures.html"
    assert (project.root / "view" / content["pictures"]).exists()


def test_a_damaged_surface_costs_no_page_of_before(tmp_path):
    project, _ = merged(tmp_path / "both", LINE)
    draw_views(project)
    before = (project.root / "view/index.html").read_bytes()
    (project.root / "cloud/points/000000.parquet").write_bytes(b"PAR1")
    with pytest.raises(FormatError):
        draw_views(project, most=7)
    assert (project.root / "view/index.html").read_bytes() == before


def test_a_measured_deviation_becomes_a_layer_and_a_new_one_replaces_it(tmp_path):
    project, cloud = merged(tmp_path / "both")
    draw_views(project)
    assert [layer["name"] for layer in shown(project)["models"][0]["layers"]][-1] != "deviation"
    measure_deviation(project, cloud)
    draw_views(project)
    layer = shown(project)["models"][0]["layers"][-1]
    assert (layer["name"], layer["unit"], layer["signed"]) == ("deviation", "mm", True)
    assert layer["range"] == pytest.approx([-1.0, 1.0], rel=1e-6)  # single precision


def test_a_deviation_of_another_cloud_is_not_shown(tmp_path):
    project, cloud = merged(tmp_path / "both")
    measure_deviation(project, cloud, of="older")
    draw_views(project)
    assert "deviation" not in [layer["name"] for layer in shown(project)["models"][0]["layers"]]


def test_a_deviation_that_is_named_must_be_there(tmp_path):
    project, _ = merged(tmp_path / "both")
    with pytest.raises(InputError, match="--name bow"):
        draw_views(project, deviation="bow")
    assert not (project.root / "view").exists()


def test_two_scans_are_told_apart_by_their_folders(tmp_path):
    now, _ = merged(tmp_path / "2026" / "scan")
    then, _ = merged(tmp_path / "2025" / "scan")
    draw_views(now, other=then)
    assert [model["name"] for model in shown(now)["models"]] == ["2026/scan", "2025/scan"]
    with pytest.raises(MissingResult):
        draw_views(now, other=Project(tmp_path / "nowhere"))


@pytest.fixture
def dives(tmp_path):
    """The same bed scanned twice, the second time by a log that has drifted."""
    now, cloud = merged(tmp_path / "2026" / "scan", BED)
    then, _ = merged(tmp_path / "2025" / "scan", replace(cloud, points=cloud.points + SHIFT))
    return now, then


def _compare(now, then, *, align=True):
    return compare_models(
        now, load_surface(now), then, align=align, deviation=DEVIATION, most=10**6
    )


def test_before_is_laid_on_after_and_the_page_says_by_how_much(dives):
    now, then = dives
    compared = _compare(now, then)
    first, second = compared.models
    # The same points without noise: what is left is the thinning of the surfaces to be aligned.
    np.testing.assert_allclose(second.vertices, first.vertices, atol=3e-5)
    moved = compared.alignment.shift_of_centre
    np.testing.assert_allclose(moved, -SHIFT, atol=3e-5)
    assert compared.relation.startswith("2025/scan was laid on 2026/scan: moved (-2.0")
    assert "% of 2026/scan overlaps" in compared.relation
    page = render_viewer(compared.models, title="dives", relation=compared.relation)
    assert content_of(page)["relation"] == compared.relation


def test_as_given_before_stays_where_its_poses_put_it(dives):
    compared = _compare(*dives, align=False)
    first, second = compared.models
    np.testing.assert_allclose(second.vertices, first.vertices + SHIFT, atol=1e-9)
    assert compared.alignment is None
    assert "their poses" in compared.relation


def test_scans_that_share_nothing_are_refused_with_the_way_out(dives, tmp_path):
    far, _ = merged(tmp_path / "far", replace(BED, points=BED.points + 1.0))
    with pytest.raises(Degenerate, match="--as-given"):
        _compare(dives[0], far)


def test_both_scans_have_the_same_colours(dives):
    models = content_of(render_viewer(_compare(*dives).models, title="dives"))["models"]
    layers = zip(*(model["layers"] for model in models), strict=True)
    for one, other in layers:
        assert (one["name"], one["range"]) == (other["name"], other["range"])


def test_a_cloud_too_large_for_the_page_is_thinned(tmp_path):
    project, cloud = merged(tmp_path / "both")
    assert draw_views(project, most=50).points == 50
    assert f"{len(cloud):,} points" in shown(project)["models"][0]["note"]
    with pytest.raises(InputError, match="one point or more"):
        draw_views(project, most=0)


def test_one_profile_has_a_page_and_no_pictures(tmp_path):
    project, cloud = merged(tmp_path / "line")
    result = draw_views(project)
    assert (result.pictures, result.points) == ((), len(cloud))
    assert "Only one profile" in shown(project)["models"][0]["note"]


def test_a_scan_without_points_says_so(tmp_path):
    project, _ = merged(tmp_path / "empty", LINE[:0])
    result = draw_views(project)
    assert (result.pictures, result.points) == ((), 0)
    assert "no point was found" in (project.root / "view/index.html").read_text("utf-8")
