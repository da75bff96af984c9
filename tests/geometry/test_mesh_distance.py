"""Distances from points to a surface."""

import numpy as np
import trimesh

from murkscan.geometry.mesh_distance import distance_to_mesh
from murkscan.types.mesh import Mesh


def _mesh(made):
    return Mesh(np.asarray(made.vertices, float), np.asarray(made.faces, int))


def test_a_point_is_as_far_from_a_box_as_the_formula_says():
    box = _mesh(trimesh.creation.box((2.0, 2.0, 2.0)))
    points = np.random.default_rng(0).uniform(-3, 3, (500, 3))
    outside = np.linalg.norm(np.maximum(np.abs(points) - 1, 0), axis=1)
    inside = np.minimum(np.abs(points) - 1, 0).max(axis=1)
    np.testing.assert_allclose(
        distance_to_mesh(points, box), np.maximum(outside, -inside), atol=1e-12
    )


def test_a_large_triangle_counts_as_well_as_many_small_ones():
    ball = trimesh.creation.icosphere(4, radius=0.1)
    floor = trimesh.Trimesh([[-9, -9, 0.2], [9, -9, 0.2], [0, 9, 0.2]], [[0, 1, 2]])
    both = _mesh(trimesh.util.concatenate([ball, floor]))
    points = np.array([[0.0, 0.0, 0.19], [2.0, 0.0, 0.0], [0.0, 0.0, -0.2]])
    # The ball is made of chords: 0.1 mm inside the sphere at most.
    np.testing.assert_allclose(distance_to_mesh(points, both), [0.01, 0.2, 0.1], atol=2e-4)


def test_every_triangle_is_found_however_far_the_point_is():
    ball = trimesh.creation.icosphere(3, radius=0.1)
    points = np.random.default_rng(1).normal(size=(200, 3))
    triangles = np.asarray(ball.triangles)
    brute = []
    for point in points:
        nearest = trimesh.triangles.closest_point(triangles, np.tile(point, (len(triangles), 1)))
        brute.append(np.linalg.norm(nearest - point, axis=1).min())
    np.testing.assert_allclose(distance_to_mesh(points, _mesh(ball)), brute, atol=1e-12)


def test_points_of_tiny_triangles_lie_on_them():
    ball = _mesh(trimesh.creation.icosphere(6, radius=0.1))
    weights = np.random.default_rng(2).dirichlet(np.ones(3), 500)
    corners = ball.vertices[ball.faces[np.arange(500) * 160]]
    points = np.einsum("nk,nkj->nj", weights, corners)
    np.testing.assert_allclose(distance_to_mesh(points, ball), 0, atol=1e-12)


def test_a_triangle_of_no_size_is_a_point():
    mesh = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2], [0, 0, 0]]))
    points = np.array([[0.2, 0.2, 1.0], [0.0, 0.0, -2.0]])
    np.testing.assert_allclose(distance_to_mesh(points, mesh), [1.0, 2.0], atol=1e-9)
