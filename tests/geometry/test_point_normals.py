"""Normals of bare points."""

import numpy as np
import pytest

from murkscan.errors import NotEnoughData
from murkscan.geometry.point_normals import estimate_point_normals


def test_the_normals_of_a_ball_all_point_outwards():
    points = np.random.default_rng(0).normal(size=(4000, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    normals = estimate_point_normals(points)
    # Thirty of 4000 points on a ball lie within 0.17 rad, over which a plane is good to 0.1 rad.
    assert np.einsum("ij,ij->i", normals, points).min() > np.cos(0.15)


def test_the_normals_of_a_scanned_wall_look_towards_smaller_z():
    x, y = (part.ravel() for part in np.meshgrid(np.arange(0, 0.1, 2e-3), np.arange(0, 0.1, 4e-4)))
    random = np.random.default_rng(1).permutation(len(x))
    points = np.stack([x, y, 0.5 + x * x], axis=1)[random]
    normals = estimate_point_normals(points)
    truth = np.stack([2 * points[:, 0], 0 * x, -np.ones(len(x))], axis=1)
    truth /= np.linalg.norm(truth, axis=1, keepdims=True)
    # At the rim all neighbours lie to one side, up to 4 mm away: 4 mm of a slope that changes by
    # 2 a metre.
    assert np.arccos(np.clip(np.einsum("ij,ij->i", normals, truth), -1, 1)).max() < 0.01


def patches(num_columns: int, gap: float) -> np.ndarray:
    """Give patches of 7 by 7 points 1 mm apart, tilted by turns to either side."""
    x, y = (part.ravel() for part in np.meshgrid(np.arange(7) * 1e-3, np.arange(7) * 1e-3))
    rows, columns = (part.ravel() for part in np.indices((num_columns, num_columns)))
    tilt = np.where((rows + columns) % 2, 1.0, -1.0)
    shape = np.broadcast_shapes((len(rows), 1), x.shape)
    parts = (rows[:, None] * gap + x, columns[:, None] * gap + y, tilt[:, None] * x)
    return np.stack([np.broadcast_to(part, shape).ravel() for part in parts], axis=1)


def test_each_of_many_pieces_looks_towards_smaller_z():
    normals = estimate_point_normals(patches(10, 0.1))
    np.testing.assert_allclose(normals[:, 2], -np.sqrt(0.5), rtol=1e-5)


def test_three_points_have_no_normals():
    with pytest.raises(NotEnoughData, match="at least 4"):
        estimate_point_normals(np.eye(3))
