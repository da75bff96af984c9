"""Dents as the owner of a hull gets them: a table, a drawing, and a picture of each."""

import csv

import ezdxf
import numpy as np
import pytest
from PIL import Image

from murkscan.cli.main import run
from murkscan.page import render_page
from murkscan.project import MESH, MeshResult, Project
from murkscan.report import ModelSize
from murkscan.report.walls import wall_sections
from murkscan.survey.reported import tell_beside
from murkscan.types.mesh import Mesh

from ..projects import finish

PLACE, DEPTH = np.array([0.25, 0.15]), 0.005


@pytest.fixture
def dented(tmp_path):
    """Give the folder of a plane of 0.45 m with a dent, and with a surface."""
    count = 91
    u, v = (grid.ravel() for grid in np.mgrid[0:count, 0:count])
    x, y = 0.005 * u, 0.005 * v
    away = np.hypot(x - PLACE[0], y - PLACE[1])
    noise = 2e-5 * np.random.default_rng(0).standard_normal(len(x))
    points = np.stack([x, y, 1 + DEPTH * np.exp(-((away / 0.025) ** 2)) + noise], axis=1)
    rows = np.concatenate([points, np.tile([0.0, 0, -1], (len(x), 1))], axis=1)
    np.savetxt(tmp_path / "hull.xyz", rows, "%.7f")
    out = tmp_path / "out"
    assert run(["merge", str(tmp_path / "hull.xyz"), "--out", str(out)]) == 0
    corner = (u * count + v)[(u < count - 1) & (v < count - 1)]
    faces = (corner[:, None, None] + [[0, count, 1], [1, count, count + 1]]).reshape(-1, 3)
    project = Project(out)
    finish(
        project,
        MESH,
        MeshResult(len(points), len(faces)),
        make=lambda: project.save_mesh(Mesh(points, faces, points=np.arange(len(points)))),
    )
    return out


def test_dents_are_listed_drawn_and_shown(dented, tmp_path):
    out, project = dented, Project(dented)
    (tmp_path / "hull.csv").write_text(
        "name,from_bow_m,height_m,from_centreline_m,side,sigma_mm,x_m,y_m,z_m\n"
        "a,10,3,2,S,2,0,0,1\nb,9.6,3,2,S,2,0.4,0,1\nc,10,2.6,2,S,2,0,0.4,1\n",
        "utf-8",
    )
    assert run(["georeference", str(out), "--hull", str(tmp_path / "hull.csv")]) == 0
    assert run(["measure", str(out), "dents", "--smallest-mm", "30"]) == 0
    with (out / "measure/dents-anomalies.csv").open() as file:
        (dent,) = csv.DictReader(file)
    assert dent["kind"] == "dent"
    assert float(dent["depth_mm"]) == pytest.approx(5, abs=0.4)
    assert float(dent["from_bow_m"]) == pytest.approx(9.75, abs=3e-3)
    assert float(dent["above_keel_m"]) == pytest.approx(2.85, abs=3e-3)
    assert dent["side"] == "starboard"
    (circle,) = ezdxf.readfile(out / "measure/dents.dxf").modelspace().query("CIRCLE")
    # Aft, to starboard and up, in millimetres.
    assert np.allclose(circle.dxf.center, (9750, 2000 - 5, 2850), atol=6)
    with Image.open(out / "measure/dents-1.png") as picture:
        assert np.asarray(picture).std() > 10  # something is drawn
    (told,) = tell_beside(project, ModelSize(0, 0, 0, 0, None)).walls
    page = render_page("Report", wall_sections([told]))
    assert "Dents and bumps: dents" in page
    assert "../measure/dents-1.png" in page
    assert "starboard" in page
