"""Noise that all pixels of a row have in common, as cheap sensors and analogue lines have it."""

import math
from dataclasses import replace
from functools import partial

import numpy as np
from jaxtyping import Shaped

from .._kernels.rows import HALF, row_offsets
from ..types.arrays import Scalars
from ..types.background import Noise
from .at_once import map_at_once
from .noise import Pictures
from .quantiles import count_levels_of, quantile_of_counts

_CLIP = 3.0
"""Standard deviations that a pixel's, and a row's, difference counts at most."""
_SEEN = 3.0
"""Times that rows must scatter more than their pixels' noise explains, to have noise in common."""
_TURNS = 3
"""Estimates, each with the bound that the last one gives."""
_PASSES = 2
"""Passes over a picture: what one leaves is the mean of nine rows, with steps where it ends."""
_ENOUGH = 10_000_000
"""Pixels that tell as well as more would: those of 48 PAL fields."""
_ROUNDED = 1 / math.sqrt(12)
"""Standard deviation of rounding [grey levels]."""


def estimate_rows(levels: Shaped[np.ndarray, "h w"], noise: Noise) -> Scalars:
    """Estimate by how much each row is brighter than its neighbours [grey levels]."""
    middle = np.median(levels[:, :: max(levels.shape[1] // 64, 1)], axis=1).astype(float)
    return row_offsets(levels, _CLIP * np.sqrt(noise.variance(middle) + noise.rows**2))


def learn_row_noise(pictures: Pictures, noise: Noise) -> float:
    """Estimate the standard deviation of what rows have in common; 0 where they have nothing.

    Args:
        pictures: With image rows along their rows.
        noise: Of a pixel.
    """
    pictures = pictures[:: math.ceil(sum(each.size for each in pictures) / _ENOUGH)]
    middles = map_at_once(lambda each: quantile_of_counts(count_levels_of(each), 0.5), pictures)
    level = np.array([np.median(middles)])
    alone = math.sqrt(noise.variance(level)[0] / min(each.shape[1] for each in pictures))
    # Even light is rounded alike all along a row.
    least, rows = max(_SEEN * alone, _ROUNDED), 0.0
    for _ in range(_TURNS):
        seen = map_at_once(partial(_row_scatter, noise=replace(noise, rows=rows)), pictures)
        # The mean around has a ninth of the row itself.
        rows = float(np.median(seen)) / (1 - 1 / (2 * HALF + 1))
        if rows < least:
            return 0.0
    return rows


def _row_scatter(levels: Shaped[np.ndarray, "h w"], noise: Noise) -> float:
    offsets = estimate_rows(levels, noise)
    return 1.4826 * float(np.median(np.abs(offsets - np.median(offsets))))


def without_rows(levels: Shaped[np.ndarray, "h w"], noise: Noise) -> Shaped[np.ndarray, "h w"]:
    """Take from each row what its pixels have in common, by no more than such noise reaches."""
    most = _CLIP * noise.rows
    total = np.zeros(len(levels))
    for _ in range(_PASSES):
        left = levels - total.astype(np.float32)[:, None]
        total = np.clip(total + estimate_rows(left, noise), -most, most)
    return levels - total.astype(np.float32)[:, None]
