"""White spots as round as bubbles and lamps out of focus are: no stripe, and none is seen there."""

import math

import cv2
import numpy as np
from jaxtyping import Bool, Shaped

from .._kernels.white_areas import box_white_areas

_LEAST = 5
"""Pixels across the smallest spot: a smaller one is as round as any short piece of a stripe."""
_ASPECT = 1.5
"""Height by width, or the other way round, up to which a spot may be round."""
_FULL = (0.68, 0.88)
"""Share of its upright box that a spot fills: a disc π/4; a piece of a stripe nearly all."""
_HALO = 0.25
"""Share of its size beyond which a spot's halo has sunk below white by far."""

Mask = Bool[np.ndarray, "length lines"]


def find_round_spots(
    levels: Shaped[np.ndarray, "length lines"], white: float, stretch: float
) -> Mask | None:
    """Mark the round white spots of a picture with their halo; None where there are none.

    Args:
        levels: Grey levels, a scan line in each column.
        white: Level from which a pixel is saturated.
        stretch: How much longer along scan lines a pixel is than across.
    """
    rows = np.flatnonzero(levels.max(axis=1, initial=0) >= white)
    if len(rows) == 0:
        return None
    areas = box_white_areas(levels[rows[0] : rows[-1] + 1], white)
    areas[:, 1] += rows[0]
    width, height = areas[:, 2], stretch * areas[:, 3]
    filled = areas[:, 4] / (areas[:, 2] * areas[:, 3])
    is_round = np.minimum(width, height) >= _LEAST
    is_round &= np.maximum(width, height) <= _ASPECT * np.minimum(width, height)
    is_round &= (filled > _FULL[0]) & (filled < _FULL[1])
    if not is_round.any():
        return None
    spots = np.zeros(levels.shape, np.uint8)
    for left, top, across, along in areas[is_round, :4]:
        middle = (round(left + across / 2), round(top + along / 2))
        axes = (math.ceil((0.5 + _HALO) * across), math.ceil((0.5 + _HALO) * along))
        cv2.ellipse(spots, middle, axes, 0, 0, 360, 1, cv2.FILLED)
    return spots.astype(bool)
