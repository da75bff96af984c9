"""What a cloud shows of itself: a small disc a point, the nearest on top."""

import numpy as np

from ..types.arrays import Directions, Points
from .window import Relief, Window

_RADIUS = 3
"""Radius of a disc [samples]."""


def splat_points(points: Points, normals: Directions, window: Window) -> Relief:
    """Look at points.

    Args:
        points: Points in samples of the window, with their depth.
        normals: Their unit normals in the view frame; a zero one is taken to face the viewer.
        window: The picture.

    Returns:
        What is nearest to the viewer in each sample.
    """
    width, height = window.num_samples
    owner = np.full(height * width, -1)
    nearest = np.full(height * width, np.inf)
    # Of points at one sample the last that is written stays: far ones first.
    order = np.argsort(-points[:, 2], kind="stable")
    columns, rows = np.rint(points[order, :2]).astype(int).T
    depth = points[order, 2]
    for right, down in _disc():
        sample = (rows + down) * width + columns + right
        closer = depth < nearest[sample]
        owner[sample[closer]] = order[closer]
        nearest[sample[closer]] = depth[closer]
    known = np.any(normals != 0, axis=1, keepdims=True)
    shown = np.where(known, normals, [0.0, 0.0, -1.0])
    outside = np.asarray(shown[:, 2] <= 0)
    shown = np.where(outside[:, None], shown, -shown)
    seen = owner >= 0
    return Relief(
        np.where(seen, nearest, np.nan).reshape(height, width),
        np.where(seen[:, None], shown[owner], 0.0).reshape(height, width, 3),
        (seen & outside[owner]).reshape(height, width),
    )


def _disc() -> list[tuple[int, int]]:
    span = range(-_RADIUS, _RADIUS + 1)
    return [(u, v) for u in span for v in span if u * u + v * v <= _RADIUS * _RADIUS]
