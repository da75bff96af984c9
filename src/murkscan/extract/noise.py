"""How much a pixel's grey level fluctuates, told from the recording itself."""

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from ..types.arrays import Image
from ..types.background import Background
from ..types.frame import Frame

_QUANTISATION = 1 / math.sqrt(12)
"""Standard deviation of rounding [grey levels]: no recording has less noise."""
_GAUSSIAN = 1.4826
"""Standard deviation of Gaussian noise as a multiple of its median absolute value."""

_APART = 3
"""Distance of the pixels whose differences are taken [px]."""


def learn_noise(frames: Sequence[Frame]) -> Background:
    """Estimate the standard deviation of one pixel's noise.

    Within a frame, second differences along rows hold noise and texture; between frames,
    differences hold noise and motion. Medians keep the stripe out of both, and the smaller of the
    two is nearer to noise alone.

    Args:
        frames: Frames spread over the recording, at least one.

    References:
        Immerkær, Fast noise variance estimation, CVIU 64(2), 1996, for noise from second
        differences.
    """
    within = np.median([_noise_within(frame.image) for frame in frames])
    # Fields come with odd and even rows in turn: only those of the same rows can be compared.
    alike = [[f for f in frames if f.first_row == row] for row in {f.first_row for f in frames}]
    pairs = [
        _noise_between(first.image, second.image)
        for same in alike
        for first, second in pairwise(same)
        if first.image.shape == second.image.shape
    ]
    noise = min(within, np.median(pairs)) if pairs else within
    return Background(noise=max(float(noise), _QUANTISATION))


def _noise_within(image: Image) -> float:
    levels = image.astype(np.int32)
    # Neighbours share noise where a colour mosaic or an encoder has smoothed them: look further.
    left, middle, right = (
        levels[:, : -2 * _APART],
        levels[:, _APART:-_APART],
        levels[:, 2 * _APART :],
    )
    bend = left - 2 * middle + right
    return _spread(bend) / math.sqrt(6)


def _noise_between(first: Image, second: Image) -> float:
    return _spread(second.astype(np.int32) - first) / math.sqrt(2)


def _spread(values: np.ndarray) -> float:
    """Robust standard deviation of whole numbers around 0, not itself bound to whole numbers."""
    if values.size == 0:
        return 0.0
    size = np.abs(values)
    middle = float(np.median(size))
    # Among equal whole numbers the median is the share of smaller ones that says where it lies.
    below, at = np.mean(size < middle), np.mean(size == middle)
    return _GAUSSIAN * max(middle - 0.5 + float((0.5 - below) / at), 0.0)
