"""The nearest place of a surface to each point."""

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from murkscan.geometry.closest import find_closest, open_sides
from murkscan.types.mesh import Mesh


def _tried(points, mesh):
    """Distance of each point to the nearest triangle, all of them tried."""
    away = [
        np.linalg.norm(
            trimesh.triangles.closest_point(
                mesh.vertices[mesh.faces], np.repeat(point[None], len(mesh.faces), axis=0)
            )
            - point,
            axis=1,
        ).min()
        for point in points
    ]
    return np.array(away)


@settings(deadline=None, max_examples=40)
@given(seed=st.integers(0, 2**31), faces=st.integers(1, 70))
def test_the_nearest_place_is_that_of_every_triangle_tried(seed, faces):
    random = np.random.default_rng(seed)
    mesh = Mesh(
        random.normal(size=(30, 3)), np.stack([random.permutation(30)[:3] for _ in range(faces)])
    )
    points = random.normal(size=(50, 3))
    found = find_closest(points, mesh, within=np.inf)
    np.testing.assert_allclose(found.distance, _tried(points, mesh), rtol=1e-9)
    away = np.linalg.norm(found.places - points, axis=1)
    np.testing.assert_allclose(away, found.distance, rtol=1e-9)
    # The place lies on the triangle that is named.
    named = Mesh(mesh.vertices, mesh.faces[found.face[:1]])
    assert find_closest(found.places[:1], named, within=1.0).distance[0] < 1e-9


def test_beyond_the_reach_nothing_is_found():
    mesh = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]]))
    points = np.array([[0.2, 0.2, 0.09], [0.2, 0.2, 0.11], [np.nan, 0, 0]])
    found = find_closest(points, mesh, within=0.1)
    assert found.face.tolist() == [0, -1, -1]
    assert found.distance == pytest.approx([0.09, np.inf, np.inf])
    assert np.isnan(found.places[1:]).all()


def test_where_there_is_no_surface_nothing_is_near():
    found = find_closest(
        np.zeros((2, 3)), Mesh(np.zeros((3, 3)), np.zeros((0, 3), np.int32)), within=1.0
    )
    assert np.isinf(found.distance).all()
    assert (found.face == -1).all()


def test_points_beside_a_surface_are_nearest_to_its_rim_and_those_above_it_are_not():
    count = 7
    v, u = np.mgrid[:count, :count]
    corner = (v * count + u)[:-1, :-1].ravel()
    first = np.stack([corner, corner + 1, corner + count], axis=1)
    second = np.stack([corner + 1, corner + count + 1, corner + count], axis=1)
    square = np.stack([u, v, np.zeros_like(u)], axis=2).reshape(-1, 3).astype(float)
    mesh = Mesh(square, np.concatenate([first, second]))
    points = np.random.default_rng(0).uniform(-3, count + 2, (2000, 3))
    # Beside the corners, too: there some triangle has the corner but no open side.
    beside = np.any((points[:, :2] < 0) | (points[:, :2] > count - 1), axis=1)
    np.testing.assert_array_equal(find_closest(points, mesh, within=np.inf).is_at_rim, beside)


def test_a_sliver_is_as_near_as_its_longest_side():
    thin = np.array([[0.0, 0, 0], [1, 0, 0], [0.5, 1e-13, 0], [2, 2, 2]])
    for faces in ([[0, 1, 2]], [[0, 2, 1]], [[0, 0, 1]], [[0, 0, 0]], [[1, 2, 0], [0, 0, 1]]):
        mesh = Mesh(thin, np.array(faces))
        points = np.array([[0.3, 0.0, 0.2], [-1.0, 0, 0]])
        near = 0.2 if any(len(set(face)) > 1 for face in faces) else np.hypot(0.3, 0.2)
        assert find_closest(points, mesh, within=9.0).distance == pytest.approx([near, 1.0])


def test_where_a_surface_lies_and_how_large_it_is_changes_nothing():
    ball = trimesh.creation.icosphere(3)
    points = np.random.default_rng(3).normal(size=(100, 3))
    mesh = Mesh(np.asarray(ball.vertices, float), np.asarray(ball.faces, np.int64))
    here = find_closest(points, mesh, within=np.inf)
    for scale, shift in ((1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)):
        moved = Mesh(mesh.vertices * scale + shift, mesh.faces)
        there = find_closest(points * scale + shift, moved, within=np.inf)
        # At 1,000 km from the origin a coordinate is known to 1e-10 m.
        np.testing.assert_allclose(
            there.distance, here.distance * scale, rtol=1e-9, atol=1e-9 * scale
        )


def test_a_large_wall_beside_a_fine_ball_costs_little():
    ball = trimesh.creation.icosphere(6, radius=0.2)
    wall = trimesh.Trimesh([[-9, -9, 0.5], [9, -9, 0.5], [0, 9, 0.5]], [[0, 1, 2]])
    both = trimesh.util.concatenate([ball, wall])
    mesh = Mesh(np.asarray(both.vertices, float), np.asarray(both.faces, np.int64))
    points = np.random.default_rng(4).uniform(-1, 1, (20_000, 3)) * [1, 1, 1e-3] + [0, 0, 0.5]
    found = find_closest(points, mesh, within=0.05)
    np.testing.assert_allclose(found.distance, np.abs(points[:, 2] - 0.5), atol=1e-12)


def test_a_closed_surface_has_no_open_side():
    box = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    assert not open_sides(box).any()
    assert open_sides(box[:3]).sum() == 3
