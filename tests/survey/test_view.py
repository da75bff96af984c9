"""The view stage on small projects, made by hand."""

import json
import re

import numpy as np
import pytest

from murkscan.errors import InputError, MissingResult
from murkscan.io.deviation_files import save_deviation_ply
from murkscan.io.json_files import save_json
from murkscan.mesh import GridMesh
from murkscan.project import Project
from murkscan.survey.view import draw_views
from murkscan.types.deviation import Deviation

from ..scans import scan_cloud, step

SCAN = scan_cloud(step, spacing=4e-3)
LINE = SCAN[SCAN.frame == 3]
"""One profile: without a surface no pictures are drawn, which take seconds."""


def merged(folder, cloud=LINE):
    """Make the project of a merged cloud, with a surface if it has one."""
    project = Project(folder)
    project.save_scan({"recording": {}, "rig": {}, "versions": {}, "merged": ["a", "b"]})
    mesh = GridMesh().mesh(cloud)
    made = {"cloud": {"points": len(cloud)}, "mesh": {"faces": len(mesh.faces)}}
    inputs = {}
    for name, result in made.items():
        stage = project.stage(name, settings={}, inputs=inputs)
        stage.begin()
        if name == "cloud":
            with project.writing_cloud() as write:
                write(cloud)
        elif len(mesh.faces):
            project.save_mesh(mesh)
        stage.finish(result, since=0.0)
        inputs = {name: stage.digest}
    return project, cloud


def shown(project):
    """Give what the page says of its models."""
    page = (project.root / "view/index.html").read_text("utf-8")
    return json.loads(re.search(r'id="content">(.*?)</script>', page, re.S)[1])


def measure_deviation(project, cloud, *, name="deviation"):
    values = np.where(cloud.points[:, 1] > 0, 1e-3, np.nan)
    deviation = Deviation(values, np.zeros_like(cloud.points), np.zeros(len(cloud)))
    folder = project.root / "measure"
    save_deviation_ply(folder / f"{name}.ply", cloud.points, deviation, np.zeros(len(cloud)))
    digest = project.finished("cloud").digest
    save_json(folder / f"{name}.json", {"inputs": {"cloud": digest}})


def test_a_merged_cloud_gets_pictures_and_a_page(tmp_path):
    project, cloud = merged(tmp_path / "both", SCAN)
    result = draw_views(project)
    assert (len(result["pictures"]), result["points"]) == (9, len(cloud))
    content = shown(project)
    assert content["title"] == "both"
    assert content["pictures"] == "pictures.html"
    assert (project.root / "view" / content["pictures"]).exists()


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
    measure_deviation(project, cloud)
    save_json(project.root / "measure/deviation.json", {"inputs": {"cloud": "older"}})
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


def test_a_cloud_too_large_for_the_page_is_thinned(tmp_path):
    project, cloud = merged(tmp_path / "both")
    assert draw_views(project, most=50)["points"] == 50
    assert f"{len(cloud):,} points" in shown(project)["models"][0]["note"]
    with pytest.raises(InputError, match="one point or more"):
        draw_views(project, most=0)


def test_one_profile_has_a_page_and_no_pictures(tmp_path):
    project, cloud = merged(tmp_path / "line")
    result = draw_views(project)
    assert (result["pictures"], result["points"]) == ([], len(cloud))
    assert "Only one profile" in shown(project)["models"][0]["note"]


def test_a_scan_without_points_says_so(tmp_path):
    project, _ = merged(tmp_path / "empty", LINE[:0])
    assert draw_views(project) == {"pictures": [], "points": 0}
    assert "no point was found" in (project.root / "view/index.html").read_text("utf-8")
