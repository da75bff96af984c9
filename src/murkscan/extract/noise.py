"""How much a pixel's grey level fluctuates, told from the recording itself."""

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from jaxtyping import Float, Int32, Shaped

from .._kernels.counts import (
    count_bends,
    count_changes,
    list_fourth_differences,
    sort_by,
    winsorise,
)
from ..types.arrays import Image, Scalars
from ..types.background import Background, Noise
from ..types.frame import Frame
from .at_once import map_at_once
from .quantiles import Counts, count_levels_of, quantile_of_counts

_QUANTISATION = 1 / math.sqrt(12)
"""Standard deviation of rounding [grey levels]: no recording has less noise."""
_GAUSSIAN = 1.4826
"""Standard deviation of Gaussian noise as a multiple of its median absolute value."""

Pictures = Sequence[Shaped[np.ndarray, "_ _"]]
"""Pictures that may differ in size, as the fields of an odd number of rows do."""
_APART = 3
"""Distance of the pixels whose differences are taken [px]."""


def learn_noise(frames: Sequence[Frame]) -> Background:
    """Estimate the standard deviation of one pixel's noise, and how much a grey level is.

    Within a frame, second differences along rows hold noise and texture; between frames,
    differences hold noise and motion. Medians keep the stripe out of both, and the smaller of the
    two is nearer to noise alone.

    Args:
        frames: Frames spread over the recording, at least one.

    References:
        Immerkær, Fast noise variance estimation, CVIU 64(2), 1996, for noise from second
        differences.
    """
    every = _row_step([frame.image for frame in frames])
    within = np.median(map_at_once(lambda frame: _noise_within(frame.image, every), frames))
    # Fields come with odd and even rows in turn: only those of the same rows can be compared.
    alike = [[f for f in frames if f.first_row == row] for row in {f.first_row for f in frames}]
    pairs = [
        (first.image, second.image)
        for same in alike
        for first, second in pairwise(same)
        if first.image.shape == second.image.shape
    ]
    between = map_at_once(lambda pair: _noise_between(*pair, every), pairs)
    noise = min(within, np.median(between)) if between else within
    return Background(noise=max(float(noise), _QUANTISATION), scale=_find_scale(frames))


def _find_scale(frames: Sequence[Frame]) -> float:
    """Tell from the bits that the pictures use how much a grey level is."""
    brightest = max(int(frame.image.max(initial=0)) for frame in frames)
    return float(2 ** max(brightest.bit_length() - 8, 0))


def _row_step(images: Pictures) -> int:
    """Give of how many rows one is looked at, so that no more pixels are than tell."""
    return math.ceil(sum(image.size for image in images) / _ENOUGH)


def _noise_within(image: Image, every: int) -> float:
    # Neighbours share noise where a colour mosaic or an encoder has smoothed them: look further.
    counts = np.zeros(4 * np.iinfo(image.dtype).max + 1, int)
    count_bends(image, _APART, every, counts)
    return _spread(counts) / math.sqrt(6)


def _noise_between(first: Image, second: Image, every: int) -> float:
    counts = np.zeros(np.iinfo(first.dtype).max + 1, int)
    count_changes(first, second, every, counts)
    return _spread(counts) / math.sqrt(2)


def _spread(counts: Counts) -> float:
    """Robust standard deviation of whole numbers around 0, not itself bound to whole numbers.

    Args:
        counts: How often each size is met.
    """
    total = int(counts.sum())
    if total == 0:
        return 0.0
    middle = int(np.searchsorted(np.cumsum(counts), (total - 1) // 2, side="right"))
    # Among equal whole numbers the median is the share of smaller ones that says where it lies.
    below, at = counts[:middle].sum() / total, counts[middle] / total
    return _GAUSSIAN * max(middle - 0.5 + float((0.5 - below) / at), 0.0)


_REACH, _SQUARES = 5, 70.0
"""Pixels of a fourth difference, which is blind to all that a cubic follows, and the sum of the
squares of their weights 1, -4, 6, -4, 1."""
_CLOSE, _LEFT, _TURNS = 2.5, 0.9776, 12
"""Standard deviations beyond which a difference counts as one of these, what is left of a
Gaussian's variance by that, and how often that is done."""
_BIN = (3.0, 0.2)
"""Least width of a bin of levels [grey levels], and as a share of the level. Rounding would bias
narrower ones."""
_FEW = 500
"""Differences that a bin has at least: their variance is then known to 6 %."""

_ENOUGH = 10_000_000
"""Pixels that tell the law as well as more would: those of 48 PAL fields."""
_DARKER = 0.85
"""Share of white below which pixels tell."""
_NEAR, _NEXT, _APART_IN_MOSAIC, _FAR = 1, 2, 4, 8
"""Distances of the pixels whose differences are taken: neighbours, the next, those that share no
noise where a camera has filled in the colours of a mosaic, and those of other blocks of an
encoder."""
_SHARED = 1.5
"""Ratio of the noise of next pixels to that of neighbours from which neighbours share it: 2.1 where
a mosaic's colours were filled in, 1.03 and less in grey pictures, with or without texture
(benchmarks/murk.py, c3 and lamp rows)."""
_ALIKE = 1.2
"""The same, from which they share some: 1.5 in H.264 of 2.8 Mbit/s (there, too)."""
_SMOOTHED = 1.5
"""Ratio of the noise of far pixels to that of near ones, which then is less than rounding alone
gives, from which an encoder has smoothed it away: 2.1 in H.265 of 2.8 Mbit/s, 3.4 to 5.4 in H.264
of crf 23 and MJPEG, 1.08 and less where nothing was encoded (benchmarks/murk.py, seed 21)."""
_STEP = 1.0
"""Least variance then [grey levels²]: what is left are blocks that differ by a level."""

Sums = Int32[np.ndarray, " n"]
Bins = Float[np.ndarray, "bins 3"]
"""Mean level, variance of a pixel, number of differences."""


def learn_levels(images: Pictures) -> Noise:
    """Estimate how a pixel's noise grows with its level, from differences within pictures.

    Args:
        images: Pictures with the stripe along their rows, at least one.

    References:
        Foi, Trimeche, Katkovnik and Egiazarian, Practical Poissonian-Gaussian noise modeling and
        fitting for single-image raw-data, IEEE TIP 17(10), 2008, for the law; the differences and
        the one-sided fit are ours.
    """
    counts = map_at_once(count_levels_of, images)
    white = _learn_white(np.sum(counts, axis=0))
    every = _row_step(images)
    level = float(np.median([quantile_of_counts(own, 0.5) for own in counts]))

    def learn(bends: tuple[Sums, Sums]) -> tuple[Noise, float]:
        law = _learn_law(*bends, white)
        return law, law.fixed + law.gain * level

    near = _list_bends(images, _NEAR, every)
    law, alone = learn(near)
    if alone < _QUANTISATION**2:
        far = _list_bends(images, _FAR, every)
        if _spread_of_most(far[1]) > _SMOOTHED * _spread_of_most(near[1]):
            return replace(learn(far)[0], least=_STEP, shared=True, smoothed=True)
    _, beside = learn(_list_bends(images, _NEXT, every))
    if beside > _SHARED * alone:
        law, _ = learn(_list_bends(images, _APART_IN_MOSAIC, every))
    return replace(law, shared=beside > _ALIKE * alone > 0.0)


def _list_bends(images: Pictures, lag: int, every: int) -> tuple[Sums, Sums]:
    """List levels and differences of pixels that are `lag` apart, of every so many rows."""
    listed = map_at_once(lambda image: list_fourth_differences(image, lag, every), images)
    levels, bends = (np.concatenate(parts) for parts in zip(*listed, strict=True))
    return levels, bends


def _spread_of_most(bends: Sums) -> float:
    """Give the variance of a pixel by differences that count no more than rounding explains.

    Where an encoder has left nearly all pixels alike, their own spread is 0, and tells no others.
    """
    most = round(_CLOSE * math.sqrt(_SQUARES) * _QUANTISATION)
    sizes = np.bincount(np.minimum(np.abs(bends), most), minlength=most + 1)
    return float(sizes @ np.arange(most + 1) ** 2 / max(len(bends), 1)) / _SQUARES


def _learn_law(levels: Sums, bends: Sums, white: float) -> Noise:
    """Estimate the noise from differences, and the sums of the levels of their pixels."""
    levels, bends = sort_by(levels, bends, int(levels.max(initial=0)))
    dark = int(np.searchsorted(levels, _DARKER * white * _REACH))
    bins = _bin_bends(levels[:dark], bends[:dark])
    # Where black cuts the noise off, it seems to grow with the level.
    whole = bins[bins[:, 0] > _CLOSE * np.sqrt(bins[:, 1])]
    if len(whole) == 0:
        return Noise(_average(bins), 0.0, white)
    fixed, gain = _fit_law(whole)
    return Noise(fixed, gain, white)


def _learn_white(counts: Counts) -> float:
    """Give the level that clipped pixels pile up at; the largest that there is where none do."""
    top = int(np.flatnonzero(counts)[-1])
    at_top, below = counts[top], counts[max(top - 5, 0) : top].sum() / 5
    # Even pictures, such as a codec's black, pile up as well.
    middle = int(np.searchsorted(np.cumsum(counts), 0.5 * counts.sum()))
    piled = at_top > max(50, 5 * below) and top > 2 * middle + 10
    return float(top if piled else len(counts) - 1)


def _bin_bends(levels: Sums, bends: Sums) -> Bins:
    """Give mean level, variance of a pixel and number of differences of each full bin.

    Args:
        levels: Sums of the levels of as many pixels as a difference has, in order.
        bends: The differences.
    """
    rows: list[tuple[float, float, float]] = []
    first = 0
    while first < len(levels):
        level = levels[first] / _REACH
        end = level + max(_BIN[0], _BIN[1] * level)
        last = max(int(np.searchsorted(levels, end * _REACH)), first + _FEW)
        if last <= len(levels):
            variance = winsorise(bends[first:last], _CLOSE, _LEFT, _TURNS) / _SQUARES
            mean = float(levels[first:last].mean()) / _REACH
            rows.append((mean, variance, float(last - first)))
        first = last
    return np.array(rows, float).reshape(-1, 3)


def _average(bins: Bins) -> float:
    """Give the variance over all levels; 0 where nothing is known."""
    return float(np.average(bins[:, 1], weights=bins[:, 2])) if bins[:, 2].any() else 0.0


def _fit_law(bins: Bins) -> tuple[float, float]:
    """Fit variance = fixed + gain · level under most bins: structure only adds to it."""
    levels = bins[:, 0]
    if len(levels) < 3 or levels.max() <= 1.5 * levels.min() + 2.0:
        return _average(bins), 0.0
    law = _fit_under(bins, np.stack([np.ones_like(levels), levels], axis=1))
    if law[1] <= 0:
        return _average(bins), 0.0
    return float(law[0]), float(law[1])


def _fit_under(bins: Bins, columns: Float[np.ndarray, "bins terms"]) -> Scalars:
    """Fit a sum of terms to variances, so that bins that lie above count little."""
    _, variances, counts = bins.T
    trust = np.sqrt(counts) / np.maximum(variances, 0.05)
    weights = trust
    law = np.zeros(columns.shape[1])
    for _ in range(20):
        law = np.linalg.lstsq(columns * weights[:, None], variances * weights, rcond=None)[0]
        above = (variances - columns @ law) / np.maximum(columns @ law, 0.05)
        weights = trust / np.sqrt(1 + (np.maximum(above, 0.0) / 0.05) ** 2)
    return law


def fit_law(bins: Bins, least: Noise) -> Noise:
    """Fit fixed + gain · level + relative · level² to variances, none below a known law.

    Args:
        bins: Level, variance and number of values of each bin.
        least: The law that variances cannot be below.
    """
    if len(bins) < 3 or bins[:, 0].max() <= 1.5 * bins[:, 0].min() + 2.0:
        terms = np.array([_average(bins), 0.0, 0.0])
    else:
        from scipy.optimize import nnls  # loaded when due: it takes a twentieth of a second

        levels, variances, counts = bins.T
        columns = np.stack([np.ones_like(levels), levels, levels**2], axis=1)
        weights = np.sqrt(counts) / np.maximum(variances, 0.05)
        terms = nnls(columns * weights[:, None], variances * weights)[0]
    fixed, gain, relative = np.maximum(terms, (least.fixed, least.gain, least.relative))
    return replace(least, fixed=float(fixed), gain=float(gain), relative=float(relative))
