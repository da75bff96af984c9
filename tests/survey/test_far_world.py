"""A scan whose world counts from far away, as UTM does."""

import numpy as np
import pytest

from murkscan.cloud import merge_profiles
from murkscan.io.cloud_files import load_cloud_file
from murkscan.io.mesh_files import load_mesh
from murkscan.mesh import GridMesh
from murkscan.project import CLOUD, EXTRACT, MOTION, Project
from murkscan.project.results import CloudResult, ExtractResult, MotionResult
from murkscan.survey.export import export_cloud
from murkscan.survey.mesh import build_mesh
from murkscan.types.pose import Pose
from murkscan.view.packing import pack_positions

from ..projects import SCAN, finish, save_cloud
from ..scans import cylinder, scan

FAR = np.array([432100.0, 5412345.0, -12.0])


def made(folder, shift):
    """Make a project of a cylinder, in a world that counts from elsewhere."""
    profile, trajectory = scan(cylinder, spacing=4e-3, noise=1e-5)
    trajectory = trajectory.carry(Pose(np.eye(3), shift))
    cloud = merge_profiles(profile, trajectory, axes=("x",))
    project = Project(folder)
    project.save_scan(SCAN)
    finish(project, EXTRACT, ExtractResult((0,), 30, 0, 0, len(profile)))
    poses = MotionResult(2)
    finish(project, MOTION, poses, make=lambda: project.save_trajectory(trajectory))
    finish(project, CLOUD, CloudResult(len(cloud), 0), make=lambda: save_cloud(project, cloud))
    build_mesh(project, GridMesh())
    return project


@pytest.fixture(scope="module")
def both(tmp_path_factory):
    folder = tmp_path_factory.mktemp("worlds")
    return made(folder / "near", np.zeros(3)), made(folder / "far", FAR)


def lies_elsewhere(near, far, atol):
    np.testing.assert_allclose(far - FAR, near, rtol=0, atol=atol)


@pytest.mark.parametrize("suffix", [".ply", ".laz", ".e57", ".csv"])
def test_a_cloud_far_away_is_the_same_cloud(both, tmp_path, suffix):
    clouds = []
    for project in both:
        export_cloud(project, tmp_path / f"cloud{suffix}")
        clouds.append(load_cloud_file(tmp_path / f"cloud{suffix}").points)
    # A double of 5 million metres resolves 1 nm; LAZ counts steps of 10 µm, which agree.
    lies_elsewhere(*clouds, atol=1e-6)


@pytest.mark.parametrize(("suffix", "atol"), [("ply", 1e-6), ("stl", 1e-5), ("glb", 1e-5)])
def test_a_surface_far_away_is_the_same_surface(both, suffix, atol):
    near, far = (load_mesh(project.root / "mesh" / f"mesh.{suffix}") for project in both)
    order = [np.lexsort(mesh.vertices.round(5).T) for mesh in (near, far)]
    assert len(near.faces) == len(far.faces)
    if suffix == "stl":  # which joins corners that are the same number: compare their boxes
        lies_elsewhere(near.vertices.min(axis=0), far.vertices.min(axis=0), atol)
        lies_elsewhere(near.vertices.max(axis=0), far.vertices.max(axis=0), atol)
    else:
        lies_elsewhere(near.vertices[order[0]], far.vertices[order[0]], atol)


def test_scan_json_says_where_stl_and_glb_count_from(both):
    near, far = both
    assert near.load_scan().origin == (0, 0, 0)
    assert np.abs(np.array(far.load_scan().origin) - FAR).max() <= 1


def test_the_page_counts_from_its_own_corner(both):
    clouds = [project.load_cloud() for project in both]
    near, far = (pack_positions(cloud.points, cloud.sigma) for cloud in clouds)
    assert near.step == pytest.approx(far.step)
    lies_elsewhere(np.array(near.low), np.array(far.low), atol=1e-8)
