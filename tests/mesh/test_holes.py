"""Holes are closed on request, up to a size, and marked."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from murkscan._kernels.fill_hole import least_area
from murkscan.errors import InputError
from murkscan.mesh import GridMesh, close_holes
from murkscan.types.mesh import Mesh

from ..scans import holed, plane, scan_cloud


@pytest.fixture(scope="module")
def wall():
    """A wall with a round hole of 40 mm."""
    return GridMesh().mesh(scan_cloud(holed, spacing=2e-3))


def area(mesh, which=slice(None)):
    a, b, c = (mesh.vertices[corner] for corner in mesh.faces[which].T)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


def normals(mesh):
    a, b, c = (mesh.vertices[corner] for corner in mesh.faces.T)
    return np.cross(b - a, c - a)


def sides(mesh):
    pairs = np.concatenate([mesh.faces[:, [i, (i + 1) % 3]] for i in range(3)])
    return np.unique(np.sort(pairs, axis=1), axis=0, return_counts=True)


def test_a_hole_up_to_the_limit_is_closed_and_marked(wall):
    closed = close_holes(wall, largest=0.05)
    assert (closed.num_closed, closed.num_left) == (1, 0)
    mesh = closed.mesh
    np.testing.assert_array_equal(mesh.vertices, wall.vertices)
    np.testing.assert_array_equal(mesh.faces[~mesh.filled], wall.faces)
    # A disc of 20 mm radius; its rim is the last points seen, up to 2 mm outside.
    assert np.pi * 0.02**2 < area(mesh, mesh.filled) < np.pi * 0.022**2 * 1.05
    # All triangles face the camera, and no side has three of them.
    assert (normals(mesh)[:, 2] < 0).all()
    assert sides(mesh)[1].max() == 2


def test_a_hole_above_the_limit_stays_open(wall):
    closed = close_holes(wall, largest=0.03)
    assert (closed.num_closed, closed.num_left) == (0, 1)
    assert not closed.mesh.filled.any()
    np.testing.assert_array_equal(closed.mesh.faces, wall.faces)


def test_the_outer_rim_is_never_closed(wall):
    closed = close_holes(wall, largest=10.0)
    assert closed.num_closed == 1
    hole = close_holes(wall, largest=0.05)
    np.testing.assert_array_equal(closed.mesh.faces, hole.mesh.faces)


def test_two_holes_that_touch_in_a_point_are_two_holes():
    cloud = scan_cloud(plane, spacing=2e-3)
    # Cells of points lacking at two squares that share one corner.
    gone = (
        (cloud.frame >= 20) & (cloud.frame < 24) & (cloud.scan_line >= 80) & (cloud.scan_line < 84)
    )
    gone |= (
        (cloud.frame >= 25) & (cloud.frame < 29) & (cloud.scan_line >= 85) & (cloud.scan_line < 89)
    )
    closed = close_holes(GridMesh().mesh(cloud[~gone]), largest=0.05)
    assert closed.num_closed == 2
    mesh = closed.mesh
    whole = GridMesh().mesh(cloud)
    assert area(mesh) == pytest.approx(area(whole), rel=1e-9)
    assert sides(mesh)[1].max() == 2


def test_closing_twice_changes_nothing_more(wall):
    once = close_holes(wall, largest=0.05).mesh
    twice = close_holes(once, largest=0.05)
    assert twice.num_closed == 0
    np.testing.assert_array_equal(twice.mesh.faces, once.faces)
    np.testing.assert_array_equal(twice.mesh.filled, once.filled)


@pytest.mark.parametrize("largest", [0.0, -1.0, float("nan")])
def test_a_limit_without_size_is_refused(wall, largest):
    with pytest.raises(InputError, match="larger than 0"):
        close_holes(wall, largest=largest)


def test_a_mesh_without_triangles_has_no_holes():
    closed = close_holes(Mesh(np.zeros((0, 3)), np.zeros((0, 3), int)), largest=0.1)
    assert (closed.num_closed, closed.num_left, len(closed.mesh.faces)) == (0, 0, 0)


@given(count=st.integers(3, 24), seed=st.integers(0, 1000))
@settings(max_examples=40, deadline=None)
def test_a_convex_outline_is_covered_once(count, seed):
    random = np.random.default_rng(seed)
    angle = np.sort(random.uniform(0, 2 * np.pi, count))
    points = np.stack([np.cos(angle), np.sin(angle), np.zeros(count)], axis=1)
    made = least_area(points, np.zeros((count, count), bool))
    assert made.shape == (count - 2, 3)
    x, y = points[:, 0], points[:, 1]
    true = 0.5 * (x * np.roll(y, -1) - y * np.roll(x, -1)).sum()
    assert area(Mesh(points, made)) == pytest.approx(true, rel=1e-9)
    assert (normals(Mesh(points, made))[:, 2] >= 0).all()


def test_bars_that_leave_no_cover_leave_the_hole():
    square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    barred = np.zeros((4, 4), bool)
    barred[0, 2] = True
    assert sorted(map(tuple, least_area(square, barred))) == [(0, 1, 3), (1, 2, 3)]
    barred[1, 3] = True
    assert len(least_area(square, barred)) == 0
