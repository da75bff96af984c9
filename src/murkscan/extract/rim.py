"""A bright or dark frame round the picture, as many cameras' and grabbers' files have."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float32, Shaped

from ..types.arrays import Image
from ..types.background import FixedPattern, Noise
from ..types.frame import Frame

_WIDEST = 4
_DEPTH = _WIDEST + 3
"""Pixels of the widest rim, and of what is looked at to see that it has ended."""
_FEW = 9
"""Frames whose median tells."""
_STEP, _EVEN = 0.08, 0.25
"""Share of white by which a rim differs from what is inside, and the share of that by which pixels
inside differ from one another at most."""


def add_rim(
    frames: Sequence[Frame], noise: Noise, patterns: Sequence[FixedPattern]
) -> tuple[FixedPattern, ...]:
    """Add the picture's rim to what is known to be fixed to it; a single picture tells.

    Args:
        frames: Frames spread over the recording, at least one.
        noise: Of a pixel.
        patterns: What else is known, none or one for each kind of field.
    """
    known = {pattern.first_row: pattern for pattern in patterns}
    return tuple(
        pattern
        for row in sorted({frame.first_row for frame in frames})
        if (pattern := _with_rim([f for f in frames if f.first_row == row], noise, known.get(row)))
    )


def _with_rim(
    frames: Sequence[Frame], noise: Noise, pattern: FixedPattern | None
) -> FixedPattern | None:
    pictures = [f.image for f in frames if f.image.shape == frames[0].image.shape]
    middle = _middle_of_border(pictures[:_FEW])
    is_rim = _find_rim(middle, _STEP * noise.white)
    if not is_rim.any():
        return pattern
    inside = np.where(is_rim, np.nan, middle)
    levels = np.zeros(middle.shape, np.float32) if pattern is None else pattern.levels.copy()
    levels[is_rim] = (middle - _extend(inside))[is_rim]
    overlay = is_rim if pattern is None or pattern.overlay is None else is_rim | pattern.overlay
    return FixedPattern(frames[0].first_row, levels, overlay)


def _middle_of_border(pictures: Sequence[Image]) -> Float32[np.ndarray, "h w"]:
    """Give the median of each pixel as near to the border as is looked; NaN further in."""
    middle = np.full(pictures[0].shape, np.nan, np.float32)
    for side, views in zip(_sides(middle), zip(*map(_sides, pictures), strict=True), strict=True):
        side[:_DEPTH] = np.median(np.stack([view[:_DEPTH] for view in views]), axis=0)
    return middle


def _find_rim(levels: Float32[np.ndarray, "h w"], step: float) -> Bool[np.ndarray, "h w"]:
    is_rim = np.zeros(levels.shape, bool)
    for side, marks in zip(_sides(levels), _sides(is_rim), strict=True):
        marks[: _rim_width(side, step)] = True
    return is_rim


def _sides(
    image: Shaped[np.ndarray, "h w"],
) -> tuple[Shaped[np.ndarray, "_ _"], ...]:
    """View a picture from its four sides, each with its outermost pixels in the first row."""
    return image, image[::-1], image.T, image.T[::-1]


def _rim_width(side: Float32[np.ndarray, "depth along"], step: float) -> int:
    """Measure how many pixels the rim is wide; 0 where there is none."""
    if len(side) < _WIDEST + _DEPTH:
        return 0
    steps = np.median(np.abs(np.diff(side[:_DEPTH], axis=0)), axis=1)
    edge = int(np.argmax(steps[:_WIDEST]))
    even = np.median(steps[edge + 1 :]) < _EVEN * steps[edge]
    return edge + 1 if steps[edge] > step and even else 0


def _extend(inside: Float32[np.ndarray, "h w"]) -> Float32[np.ndarray, "h w"]:
    """Go on beyond the picture's inside as it ends."""
    rows = np.flatnonzero(np.isfinite(inside).any(axis=1))
    columns = np.flatnonzero(np.isfinite(inside).any(axis=0))
    height, width = inside.shape
    at_row = np.clip(np.arange(height), rows[0], rows[-1])
    at_column = np.clip(np.arange(width), columns[0], columns[-1])
    return inside[at_row[:, None], at_column]
