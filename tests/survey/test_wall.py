"""murkscan measure wall, on the cloud of another program."""

import csv
import json

import numpy as np
import pytest
from PIL import Image

from murkscan.cli.main import run
from murkscan.page import render_page
from murkscan.project import MESH, MeshResult, Project
from murkscan.report import ModelSize
from murkscan.report.walls import wall_sections
from murkscan.simulate.shapes import SheetPile
from murkscan.survey.reported import digest_beside, tell_beside

from ..projects import finish


@pytest.fixture(scope="module")
def wall(tmp_path_factory):
    """Give a folder with the points of a wall of sheet piles that bulges by 30 mm."""
    folder = tmp_path_factory.mktemp("wall")
    x, y = (grid.ravel() for grid in np.mgrid[-0.6:0.6:0.01, -2:2:0.01])
    shape = SheetPile(width=1.2, height=4.0, bulge=0.03, bulge_width=0.5)
    points = np.stack([x, y, 0.6 + shape.depth_at(x, y)], axis=1)
    normals = np.tile([0.0, 0.0, -1.0], (len(x), 1))
    np.savetxt(folder / "wall.xyz", np.concatenate([points, normals], axis=1), "%.7f")
    out = folder / "out"
    assert run(["merge", str(folder / "wall.xyz"), "--out", str(out)]) == 0
    return out


def test_a_wall_is_drawn_tabled_and_mapped(wall, capsys):
    plane = ("--point-m", "0,0,0.6", "--normal", "0,0,-1", "--sections", "4")
    assert run(["measure", str(wall), "wall", *plane, "--ribbed", "--strip-mm", "50"]) == 0
    assert "1 parts off by more than 10 mm" in capsys.readouterr().out
    folder = wall / "measure"
    with (folder / "wall-curves.csv").open() as file:
        rows = list(csv.DictReader(file))
    shape = SheetPile(width=1.2, height=4.0, bulge=0.03, bulge_width=0.5)
    for row in rows:
        x, y = float(row["x_m"]), float(row["y_m"])
        across = x + np.linspace(-0.02, 0.02, 5)
        truth = -1e3 * shape.depth_at(across, np.full(5, y)).mean()
        if abs(np.mod(x, 0.3) - 0.075) < 0.03:  # a strip within a face
            assert abs(float(row["distance_mm"]) - truth) < 1.0
        low, high = float(row["low_95_mm"]), float(row["high_95_mm"])
        assert low <= float(row["distance_mm"]) <= high
    (bulge,) = json.loads((folder / "wall.json").read_text("utf-8"))["details"]["anomalies"]
    # Half of the height lies within a metre, where the bulge is 4 mm: the median takes that off.
    assert bulge["distance_mm"] == pytest.approx(26, abs=1)
    assert abs(bulge["y_m"]) < 0.1


def test_the_map_opens_where_geotiff_does(wall):
    plane = ("--point-m", "0,0,0.6", "--normal", "0,0,-1", "--name", "map")
    assert run(["measure", str(wall), "wall", *plane, "--cell-mm", "50", "--sections", "0"]) == 0
    with Image.open(wall / "measure" / "map.tif") as map_:
        values = np.asarray(map_)
        assert map_.tag_v2[33550] == pytest.approx((0.05, 0.05, 0.0))
        assert map_.tag_v2[33922][3:5] == pytest.approx((0.0, 0.05 * len(values)))
        assert "elevation of a wall" in map_.tag_v2[34737]
    assert values[values > -9999].max() == pytest.approx(0.03, abs=1e-3)


def test_a_cylinder_that_is_given_shows_all_of_a_bulge(tmp_path):
    along, y = (grid.ravel() for grid in np.mgrid[-0.3:0.3:0.01, -1:1:0.01])
    bulge = 0.02 * np.exp(-(along**2 + y**2) / (2 * 0.3**2))
    angle, reach = along / 0.8, 0.8 + bulge
    out = np.stack([np.sin(angle), 0 * angle, -np.cos(angle)], axis=1)
    points = reach[:, None] * out + np.stack([0 * y, y, 0 * y + 2.0], axis=1)
    np.savetxt(tmp_path / "pile.xyz", np.concatenate([points, out], axis=1), "%.7f")
    folder = tmp_path / "out"
    assert run(["merge", str(tmp_path / "pile.xyz"), "--out", str(folder)]) == 0
    built = ("--point-m=0,0.3,2", "--axis=0,-5,0", "--radius-mm=800")
    assert run(["measure", str(folder), "wall", *built, "--strip-mm=60", "--sections=5"]) == 0
    told = json.loads((folder / "measure/wall.json").read_text("utf-8"))["details"]
    assert told["radius_m"] == pytest.approx(0.8)
    with (folder / "measure" / "wall-curves.csv").open() as file:
        rows = [{k: float(v or "nan") for k, v in row.items()} for row in csv.DictReader(file)]
    for row in rows:
        away = np.arctan2(row["x_m"], 2 - row["z_m"]) * 0.8
        truth = 20 * np.exp(-(away**2 + row["y_m"] ** 2) / (2 * 0.3**2))
        assert abs(row["distance_mm"] - truth) < 0.2  # half a cell on the bulge's flank


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--cell-mm", "0"), "--cell-mm must be above 0"),
        (("--point-m", "0,0,1"), "together"),
        (("--shape", "cylinder", "--axis", "0,1,0"), "--axis and --radius-mm together"),
        (("--point-m=0,0,9", "--axis=0,1,0", "--radius-mm=0"), "--radius-mm must be above 0"),
        (("--up", "0,0,1"), "--up"),
        (("--sections", "-1"), "--sections"),
        (("--cell-mm", "0.01", "--sections", "0"), "larger --cell-mm"),
    ],
)
def test_what_makes_no_map_is_one_sentence(wall, capsys, words, said):
    assert run(["measure", str(wall), "wall", *words]) == 2
    text = capsys.readouterr().err
    assert said in text
    assert text.count("\n") == 1


def test_the_report_shows_walls_of_the_present_cloud(wall):
    plane = ("--point-m", "0,0,0.6", "--normal", "0,0,-1", "--sections", "0")
    assert run(["measure", str(wall), "wall", *plane, "--name", "quay", "--ribbed"]) == 0
    project = Project(wall)
    assert "wall quay" in digest_beside(project)
    finish(project, MESH, MeshResult(0, 0))
    told = tell_beside(project, ModelSize(0, 0, 0, 0, None))
    (quay,) = (one for one in told.walls if one.name == "quay")
    assert quay.anomalies[0]["distance_mm"] > 20
    assert quay.pictures == ["quay-1.png"]
    with Image.open(wall / "measure" / "quay-1.png") as picture:
        assert np.asarray(picture).std() > 10  # something is drawn
    page = render_page("Report", wall_sections([quay]))
    assert "Wall in elevation: quay" in page
    assert "../measure/quay.png" in page
    assert "../measure/quay-1.png" in page
