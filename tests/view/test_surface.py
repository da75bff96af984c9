"""What a picture's samples show, against rays and against what must be so."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from murkscan._kernels.rasterise import cover_with_discs, cover_with_triangles
from murkscan.geometry.ray_casting import RayCaster
from murkscan.simulate.shapes import Sphere
from murkscan.types.mesh import Mesh
from murkscan.types.rays import Rays
from murkscan.view.surface import look_at_mesh, vertex_normals
from murkscan.view.window import Window

SIZE = (96, 80)
WINDOW = Window(SIZE, 1.0, (0.0, 0.0))


def rough_surface(seed, *, corners=400):
    """Triangles of all sizes and directions, in samples, some of them edge-on."""
    rng = np.random.default_rng(seed)
    points = rng.uniform([-20, -20, 0], [210, 180, 90], (corners, 3))
    faces = rng.integers(0, corners, (300, 3))
    faces = faces[(np.diff(np.sort(faces, axis=1), axis=1) > 0).all(axis=1)]
    points[faces[0, 1]] = points[faces[0, 0]] + [0.0, 0.0, 30.0]
    return Mesh(points, faces)


def buffers(size=SIZE):
    width, height = 2 * size[0], 2 * size[1]
    return np.full((height, width), np.inf, np.float32), np.zeros((height, width), np.int32)


@settings(deadline=None, max_examples=30)  # loops are compiled in the first
@given(st.integers(0, 10_000))
def test_each_sample_shows_what_a_ray_through_it_meets_first(seed):
    mesh = rough_surface(seed)
    depth, owner = buffers()
    cover_with_triangles(mesh.vertices, mesh.faces, depth, owner)
    rows, columns = np.mgrid[: depth.shape[0] : 3, : depth.shape[1] : 3].reshape(2, -1)
    origins = np.stack([columns, rows, np.full(len(rows), -10.0)], axis=1).astype(float)
    hits = RayCaster(mesh).first_hits(Rays(origins, np.tile([0.0, 0.0, 1.0], (len(rows), 1))))
    expected, got = hits.range - 10, depth[rows, columns]
    differs = ~np.isclose(
        np.nan_to_num(expected, posinf=1e9), np.nan_to_num(got, posinf=1e9), atol=1e-3
    )
    # Only on a triangle's very edge may one of both see the triangle and the other one pass it by.
    assert np.mean(differs) < 2e-3


@settings(deadline=None, max_examples=30)
@given(st.floats(0, 2 * np.pi), st.floats(0.1, 3.0))
def test_neighbouring_triangles_leave_no_crack(angle, step):
    """A net of triangles, turned in the picture, hides all that lies behind it."""
    u, v = (part.ravel() for part in np.meshgrid(np.arange(-40, 41), np.arange(-40, 41)))
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    flat = step * np.stack([u, v], axis=1) @ turn.T + np.array(SIZE)
    points = np.column_stack([flat, 0.3 * u])
    number = np.arange(81 * 81).reshape(81, 81)
    a, b, c, d = (
        number[i : 80 + i, j : 80 + j].ravel() for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))
    )
    faces = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    depth, owner = buffers()
    cover_with_triangles(points, faces, depth, owner)
    rows, columns = np.nonzero(np.isinf(depth))
    off = np.stack([columns, rows], axis=1) - np.array(SIZE)
    inside = np.abs(off @ turn).max(axis=1) < 40 * step - 1e-3
    assert not inside.any()


def test_normals_are_turned_to_the_viewer_and_sides_told_apart():
    points = np.array([[10.0, 10, 5], [60, 10, 5], [60, 60, 5], [10, 60, 5]])
    for faces, is_outside in (([[0, 2, 1], [0, 3, 2]], True), ([[0, 1, 2], [0, 2, 3]], False)):
        mesh = Mesh(points, np.array(faces))
        normals = vertex_normals(points, mesh.faces)
        relief = look_at_mesh(mesh, points, normals, WINDOW)
        assert len(relief.seen) == 51 * 51
        np.testing.assert_allclose(relief.normals, np.tile([0, 0, -1], (51 * 51, 1)), atol=1e-6)
        assert (relief.outside == is_outside).all()


def test_the_normals_of_a_ball_point_away_from_its_middle():
    ball = Sphere(1.0).mesh()
    normals = vertex_normals(ball.vertices, ball.faces)
    # Neighbours are 0.009 rad away, most unevenly beside the corners of the icosahedron that the
    # ball is made from: less than a quarter of that is left.
    assert np.einsum("ij,ij->i", normals, ball.vertices).min() > np.cos(2e-3)


def test_the_nearest_disc_is_on_top():
    depth, owner = buffers()
    points = np.array([[50.0, 40.0, 9.0], [52.0, 40.0, 3.0]])
    cover_with_discs(points, 3, depth, owner)
    assert np.isfinite(depth).sum() == 29 + 29 - np.count_nonzero(
        [
            (u - 2) ** 2 + v * v <= 9
            for u in range(-3, 4)
            for v in range(-3, 4)
            if u * u + v * v <= 9
        ]
    )
    assert depth[40, 51] == pytest.approx(3.0)
    assert owner[40, 51] == 1
