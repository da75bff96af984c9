"""Noise that all pixels of a row have in common, as cheap sensors and analogue lines have it."""

import math

import numpy as np
from jaxtyping import Shaped

from .._kernels.rows import HALF, row_offsets
from ..types.arrays import Scalars
from ..types.background import Noise
from .noise import Pictures

_CLIP = 3.0
"""Standard deviations that a pixel's, and a row's, difference counts at most."""
_SEEN = 3.0
"""Times that rows must scatter more than their pixels' noise explains, to have noise in common."""
_ROUNDED = 1 / math.sqrt(12)
"""Standard deviation of rounding [grey levels]."""


def estimate_rows(levels: Shaped[np.ndarray, "h w"], noise: Noise) -> Scalars:
    """Estimate by how much each row is brighter than its neighbours [grey levels]."""
    middle = np.median(levels[:, :: max(levels.shape[1] // 64, 1)], axis=1).astype(float)
    return row_offsets(levels, _CLIP * np.sqrt(noise.variance(middle)))


def learn_row_noise(pictures: Pictures, noise: Noise) -> float:
    """Estimate the standard deviation of what rows have in common; 0 where they have nothing.

    Args:
        pictures: With image rows along their rows.
        noise: Of a pixel.
    """
    seen = []
    for levels in pictures:
        offsets = estimate_rows(levels, noise)
        seen.append(1.4826 * float(np.median(np.abs(offsets - np.median(offsets)))))
    spread = float(np.median(seen))
    level = np.array([np.median([np.median(each) for each in pictures])])
    alone = math.sqrt(noise.variance(level)[0] / min(each.shape[1] for each in pictures))
    # The mean around has a ninth of the row itself.
    # Even light is rounded alike all along a row.
    least = max(_SEEN * alone, _ROUNDED)
    return spread / (1 - 1 / (2 * HALF + 1)) if spread > least else 0.0


def without_rows(
    levels: Shaped[np.ndarray, "h w"], noise: Noise, row_noise: float
) -> Shaped[np.ndarray, "h w"]:
    """Take from each row what its pixels have in common, by no more than such noise reaches."""
    most = _CLIP * row_noise
    offsets = np.clip(estimate_rows(levels, noise), -most, most)
    return levels - offsets.astype(np.float32)[:, None]
