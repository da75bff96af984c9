"""How wide the stripe is in a picture: what a fogged window or a lens out of focus shows first."""

import math

import numpy as np
from jaxtyping import Float

from ..types.arrays import Pixels, Scalars
from ..types.frame import Frame
from ..types.laser import Axis

_LINES = 64
"""Scan lines that are looked at, evenly spread: a median needs no more."""
_REACH = 24
"""How far a stripe is followed across itself [px of the frame]: eight times a usual one's width."""
_FEWEST = 3
"""Centres that a stripe has at least."""
_UNSPOILT = 0.95
"""Share of white from which a stripe counts as overexposed."""

Profiles = Float[np.ndarray, "lines places"]


def measure_stripe_width(frame: Frame, pixels: Pixels, axis: Axis) -> float:
    """Measure how wide the stripe is, across its own direction, at half of its height.

    Scan lines in which it is overexposed, and so wide without a blur, do not count.

    Args:
        frame: The frame.
        pixels: Its centres, in pixels of the full frame [px].
        axis: The camera axis along which the laser sits.

    Returns:
        The median over the scan lines [px of the full frame]; NaN where none tells it.
    """
    if len(pixels) < _FEWEST:
        return math.nan
    chosen = np.arange(0, len(pixels), max(len(pixels) // _LINES, 1))
    some = pixels[chosen]
    rows = (some[:, 1] - frame.first_row) / frame.row_step
    profiles = _cut(frame.image, some[:, 0], rows, 0 if axis == "y" else 1)
    peaks, grounds = profiles.max(axis=1), np.median(profiles, axis=1)
    above = profiles > ((peaks + grounds) / 2)[:, None]
    white = 2.0 ** int(frame.image.max()).bit_length() - 1
    usable = (peaks > grounds) & (peaks < _UNSPOILT * white)
    if not usable.any():
        return math.nan
    step = frame.row_step if axis == "y" else 1
    widths = _around_the_middle(above) * step * _cosines(pixels, axis)[chosen]
    return float(np.median(widths[usable]))


def _cosines(pixels: Pixels, axis: Axis) -> Scalars:
    """Compute by what the stripe is narrower across itself than along its scan lines."""
    across, along = pixels.T if axis == "x" else pixels.T[::-1]
    steps = np.gradient(along)
    slopes = np.gradient(across) / np.where(np.abs(steps) > 0, steps, 1.0)
    return 1 / np.hypot(1.0, slopes)


def _cut(image: np.ndarray, u: np.ndarray, v: np.ndarray, across: int) -> Profiles:
    """Cut grey levels out of a picture, across the stripe."""
    offsets = np.arange(-_REACH, _REACH + 1)
    at = [np.rint(v).astype(int)[:, None], np.rint(u).astype(int)[:, None]]
    at[across] = at[across] + offsets
    rows = np.clip(at[0], 0, image.shape[0] - 1)
    columns = np.clip(at[1], 0, image.shape[1] - 1)
    return image[rows, columns].astype(float)


def _around_the_middle(above: np.ndarray) -> np.ndarray:
    """Count the places in a row that are above, from the middle to either side."""
    right = np.logical_and.accumulate(above[:, _REACH:], axis=1).sum(axis=1)
    left = np.logical_and.accumulate(above[:, _REACH::-1], axis=1).sum(axis=1)
    return np.maximum(left + right - 1, 1).astype(float)
