"""What the page is given: joined, thinned, carried from one place to another."""

import hashlib
import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import murkscan.view
from murkscan.errors import InputError, NotEnoughData
from murkscan.mesh import GridMesh
from murkscan.types.frame_times import FrameTimes
from murkscan.types.pose import Pose
from murkscan.view import Layer, model_of_points, model_of_scan, render_viewer
from murkscan.view.thinned import choose_fairly, cluster_vertices

from ..scans import plane, scan, scan_cloud, sphere

VIEWER = Path(murkscan.view.__file__).parent / "viewer"


@pytest.fixture(scope="module")
def cloud():
    return scan_cloud(plane, spacing=2e-3, num_rows=80)


def area(mesh):
    a, b, c = (mesh.vertices[corner] for corner in mesh.faces.T)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


def test_a_surface_between_measured_points_adds_none(cloud):
    mesh = GridMesh().mesh(cloud)
    model = model_of_scan("plane", cloud, mesh=mesh)
    assert len(model.vertices) == model.num_measured == len(cloud)
    np.testing.assert_array_equal(model.vertices[model.faces], mesh.vertices[mesh.faces])


def test_a_surface_beside_the_points_keeps_its_own_vertices(cloud):
    mesh = GridMesh().mesh(cloud)
    moved = replace(mesh, vertices=mesh.vertices + np.array([0, 0, 1e-5]))
    model = model_of_scan("plane", cloud, mesh=moved)
    assert model.num_measured == len(cloud)
    np.testing.assert_array_equal(model.vertices[model.faces], moved.vertices[moved.faces])
    # What is known of its own point is known of the vertex.
    frames = np.unique(cloud.frame, return_inverse=True)[1]
    np.testing.assert_array_equal(model.moments[: len(cloud)], frames)
    np.testing.assert_array_equal(np.unique(model.moments), np.unique(frames))


def test_a_smoothed_surface_is_drawn_as_it_is_and_read_off_its_points():
    cloud = scan_cloud(plane, spacing=2e-3, num_rows=80, noise=2e-4)
    mesh = GridMesh().mesh(cloud)
    model = model_of_scan("plane", cloud, mesh=mesh)
    assert len(model.vertices) == model.num_measured == len(cloud)
    np.testing.assert_array_equal(np.sort(model.vertices, axis=0), np.sort(cloud.points, axis=0))
    np.testing.assert_array_equal(model.surface[model.faces], mesh.vertices[mesh.faces])
    away = np.linalg.norm(model.surface - model.vertices, axis=1)
    assert np.mean(away > 0) > 0.5
    # Sigma is kept in single precision.
    assert 0 < away.max() <= cloud.sigma.max() * (1 + 1e-4)


def test_a_vertex_beyond_a_point_s_sigma_is_another_place():
    cloud = scan_cloud(plane, spacing=2e-3, num_rows=80, noise=2e-4)
    mesh = GridMesh(smoothing=0.0).mesh(cloud)
    lifted = replace(mesh, vertices=mesh.vertices - np.array([0, 0, 3e-4]))
    model = model_of_scan("plane", cloud, mesh=lifted)
    assert len(model.vertices) == len(cloud) + len(mesh.vertices)
    np.testing.assert_array_equal(model.surface[model.faces], lifted.vertices[lifted.faces])


def test_points_lie_in_order_of_time(cloud):
    shuffled = cloud[np.random.default_rng(0).permutation(len(cloud))]
    model = model_of_scan("plane", shuffled)
    assert np.all(np.diff(model.moments[: model.num_measured]) >= 0)


def test_more_points_than_a_browser_holds_are_chosen_fairly_and_that_is_said(cloud):
    mesh = GridMesh().mesh(cloud)
    model = model_of_scan("plane", cloud, mesh=mesh, most=500)
    assert model.num_measured == 500
    assert f"500 of the scan's {len(cloud):,} points" in model.note
    assert f"of its {len(mesh.vertices):,} vertices" in model.note


def test_a_fair_choice_favours_no_part():
    chosen = choose_fairly(100_000, 20_000)
    counts = np.histogram(chosen, bins=10, range=(0, 100_000))[0]
    # 2000 a part, of binomial deviation 40: five of them.
    assert np.abs(counts - 2000).max() < 200


def test_a_thinned_surface_is_still_whole():
    mesh = GridMesh().mesh(scan_cloud(sphere, spacing=1e-3))
    thin = cluster_vertices(mesh, 1500)
    assert 600 < len(thin.vertices) <= 1500
    # Cells of 3 mm on a ball of 50 mm radius lose a chord's share at the rim and in the bulge.
    assert area(thin) == pytest.approx(area(mesh), rel=0.06)
    assert set(map(tuple, thin.vertices)) <= set(map(tuple, mesh.vertices))


def test_a_model_moves_as_a_whole():
    cloud = scan_cloud(plane, spacing=4e-3, num_rows=20)
    _, trajectory = scan(plane, spacing=4e-3, num_rows=20)
    numbers = np.unique(cloud.frame)
    frames = FrameTimes(numbers.astype(np.uint32), numbers * 0.04)
    model = model_of_scan("plane", cloud, trajectory=trajectory, frames=frames)
    turn = Rotation.from_euler("xyz", [0.3, -0.2, 1.0])
    moved = model.moved(Pose(turn.as_matrix(), np.array([1.0, 2.0, -3.0])), model.views)

    def in_camera(one):
        """The first vertex as its own camera sees it, and its normal."""
        seen = Rotation.from_quat(one.attitudes[0], scalar_first=True).inv()
        return seen.apply([one.vertices[0] - one.path[0], one.normals[0]])

    np.testing.assert_allclose(in_camera(moved), in_camera(model), atol=1e-12)
    np.testing.assert_allclose(
        moved.vertices, turn.apply(model.vertices) + np.array([1, 2, -3]), atol=1e-12
    )


def test_a_layer_of_some_points_reaches_their_vertices_wherever_they_lie(cloud):
    """Also those of a thinned surface, whose points are none of the chosen ones."""
    rows = np.flatnonzero(cloud.points[:, 1] > 0)
    mesh = GridMesh().mesh(cloud)
    model = model_of_scan("plane", cloud, mesh=mesh, most=500)
    assert model.num_measured < len(model.vertices)
    carried = model.with_layer(Layer("row", rows.astype(float), ""), rows).layers[-1].values
    upper = np.isin(model.rows, rows)
    np.testing.assert_array_equal(carried[upper], model.rows[upper])
    assert np.isnan(carried[~upper]).all()
    np.testing.assert_array_equal(upper, cloud.points[model.rows, 1] > 0)


def test_a_surface_of_other_points_is_refused(cloud):
    mesh = GridMesh().mesh(cloud)
    with pytest.raises(InputError, match="which points its vertices are"):
        model_of_scan("plane", cloud, mesh=replace(mesh, points=None))
    with pytest.raises(InputError, match="lacks points"):
        model_of_scan("plane", cloud[:50], mesh=mesh)


def test_a_layer_of_another_length_is_refused():
    model = model_of_points("line", np.eye(3))
    with pytest.raises(InputError, match="2 values for 3 places"):
        model.with_layer(Layer("deviation", np.zeros(2), "mm"))


def test_a_page_without_points_is_refused():
    with pytest.raises(NotEnoughData, match="nothing to show"):
        render_viewer([], title="nothing")
    with pytest.raises(NotEnoughData, match="empty"):
        render_viewer([model_of_points("empty", np.zeros((0, 3)))], title="nothing")


def test_points_that_are_nowhere_are_refused():
    points = np.eye(3)
    points[0, 0] = np.nan
    with pytest.raises(InputError, match="1 of 3 points"):
        render_viewer([model_of_points("broken", points)], title="broken")


def test_the_page_names_no_address_to_load_from(cloud):
    page = render_viewer([model_of_scan("plane", cloud)], title="plane")
    assert not re.findall(r"<(?:script|link|img)[^>]+(?:src|href)=", page)
    assert "default-src 'none'" in page


def test_the_committed_script_is_made_from_its_sources():
    sources = sorted((VIEWER / "source").glob("*.js"))
    files = [VIEWER / "build.js", VIEWER / "package.json", *sources]
    digest = hashlib.sha256(b"".join(file.read_bytes() for file in files)).hexdigest()
    head = (VIEWER / "viewer.js").read_text("utf-8")[:2000]
    assert digest in head, "run `make viewer`"
    assert "The MIT License" in head


def test_the_library_s_version_is_exact():
    package = json.loads((VIEWER / "package.json").read_text())
    versions = package["dependencies"] | package["devDependencies"]
    assert all(re.fullmatch(r"\d+\.\d+\.\d+", version) for version in versions.values())
