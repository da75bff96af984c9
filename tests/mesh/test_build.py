"""The mesh stage: what it writes, what it says, and what it does not begin."""

import numpy as np
import pytest

from murkscan import Project
from murkscan.errors import InputError, MissingResult
from murkscan.io.mesh_files import load_mesh
from murkscan.mesh import BySignal, GridMesh
from murkscan.project import CLOUD, CloudResult, PassResult
from murkscan.survey.mesh import Finish, build_mesh, export_mesh

from ..projects import MERGED, finish, save_cloud
from ..scans import holed, scan_cloud


@pytest.fixture
def project(tmp_path):
    """A cloud alone, as merging leaves it, of a wall with a hole of 40 mm."""
    project = Project(tmp_path / "out")
    project.save_scan(MERGED)
    cloud = scan_cloud(holed, spacing=2e-3)
    one = PassResult("wall.ply", (0, int(cloud.frame.max())), 0, "", None, ())
    result = CloudResult(len(cloud), outliers=0, passes=(one,))
    finish(project, CLOUD, result, make=lambda: save_cloud(project, cloud))
    return project


def test_a_surface_is_coloured_and_open_unless_told(project):
    result = build_mesh(project, GridMesh())
    assert (result.holes_closed, result.holes_left, result.faces_filled) == (None, None, None)
    made = {file.name for file in (project.root / "mesh").iterdir()}
    assert made == {"mesh.ply", "mesh.stl", "mesh.glb", "points.parquet", "stage.json"}
    assert project.load_mesh().colours is not None
    assert project.load_mesh().filled is None


def test_holes_are_closed_then_triangles_thinned_out(project):
    finish = Finish(largest_hole=0.05, faces=4000, paint=BySignal())
    result = build_mesh(project, GridMesh(), finish=finish)
    mesh = project.load_mesh()
    assert (result.holes_closed, result.holes_left) == (1, 0)
    assert result.faces == len(mesh.faces) <= 4000
    assert result.faces_filled == mesh.filled.sum() > 0


def test_another_finish_makes_the_surface_anew_and_the_same_does_not(project):
    build_mesh(project, GridMesh())
    before = (project.root / "mesh/mesh.ply").stat().st_mtime_ns
    build_mesh(project, GridMesh(), finish=Finish())
    assert (project.root / "mesh/mesh.ply").stat().st_mtime_ns == before
    build_mesh(project, GridMesh(), finish=Finish(paint=None))
    assert project.load_mesh().colours is None


@pytest.mark.parametrize("finish", [Finish(largest_hole=-1.0), Finish(faces=1)])
def test_what_makes_no_sense_leaves_the_surface_that_is_there(project, finish):
    build_mesh(project, GridMesh())
    before = (project.root / "mesh/mesh.ply").read_bytes()
    with pytest.raises(InputError):
        build_mesh(project, GridMesh(), finish=finish)
    assert (project.root / "mesh/mesh.ply").read_bytes() == before


def test_a_surface_is_exported_as_it_is(project, tmp_path):
    build_mesh(project, GridMesh())
    assert export_mesh(project, tmp_path / "wall.obj") == len(project.load_mesh().faces)
    back = load_mesh(tmp_path / "wall.obj")
    # Seven digits behind the point.
    np.testing.assert_allclose(back.vertices, project.load_mesh().vertices, atol=5.1e-8)
    with pytest.raises(InputError, match="no mesh format"):
        export_mesh(project, tmp_path / "wall.step")


def test_no_surface_is_exported_before_there_is_one(project, tmp_path):
    with pytest.raises(MissingResult):
        export_mesh(project, tmp_path / "wall.obj")
    assert not (tmp_path / "wall.obj").exists()
