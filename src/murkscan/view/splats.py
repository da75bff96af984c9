"""What a cloud shows of itself: a small disc a point, the nearest on top."""

import numpy as np

from .._kernels.rasterise import cover_with_discs
from ..types.arrays import Directions, Points
from .window import Relief, Window

_RADIUS = 3
"""Radius of a disc [samples]."""


def look_at_points(points: Points, normals: Directions, window: Window) -> Relief:
    """Look at points.

    Args:
        points: Points in samples of the window, with their depth.
        normals: Their unit normals in the view frame; a zero one is taken to face the viewer.
        window: The picture.

    Returns:
        What is nearest to the viewer in each sample.
    """
    depth, owner, start = window.empty_buffers(points)
    cover_with_discs(points - [0.0, 0.0, start], _RADIUS, depth, owner)
    seen = np.argwhere(np.isfinite(depth))
    shown = normals[owner[*seen.T]].astype(np.float32)
    shown[~shown.any(axis=1)] = [0.0, 0.0, -1.0]
    outside = shown[:, 2] <= 0
    return Relief(depth, start, seen, np.where(outside[:, None], shown, -shown), outside)
