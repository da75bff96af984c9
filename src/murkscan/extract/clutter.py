"""What a recording shows beside its stripe: how strongly filters answer it, and how often."""

import math
from collections.abc import Iterator, Sequence

import numpy as np
from jaxtyping import Float

from .._kernels.matched_filter import score_pixels
from ..types.arrays import Indices, Ratios
from ..types.background import Noise
from .at_once import map_at_once
from .matched_filter import MatchedFilter
from .noise import fit_law
from .ridges import Marks, Ridges
from .scan_lines import ScanLines

Rates = Float[np.ndarray, "..."]
"""Ridges in a pixel and an e-fold of height, one a bin of heights."""
Stays = Float[np.ndarray, "..."]
"""Share of clutter that stays over frames, one a bin of heights."""

_GAUSSIAN = 1.4826
"""Standard deviation of Gaussian noise as a multiple of its median absolute value."""
_EVERY, _MOST_ANSWERS = 3, 4_000_000
"""Scan lines from one to the next that are looked at, since neighbours are alike; and answers that
tell as well as more would: more than all of as many PAL fields. Of large pictures more lines are
passed over."""
_BINS, _FEWEST = 24, 400
"""Bins of the level around, and answers that each has at least."""

_TOLERATED = 2.0
"""Factor by which answers may scatter more than noise explains before scores are divided by it."""
_STEP = 0.35
"""Width of a bin of heights [e-folds]."""
_HEIGHTS = np.exp(np.log(2.5) + _STEP * np.arange(21))
"""Middles of the bins: from noise to a white stripe in a black 16-bit picture."""
_USUAL, _KNEE, _FALL = 0.02, 5.0, 1.5
"""Rate of clutter that is expected before anything is known [1/px and e-fold], up to which height,
and the power of the height by which it falls beyond: sizes of particles in the sea fall by a power
of 3 to 4 and their light grows with the square of the size (Jonasz and Fournier 2007, section 5.8).
"""
_TRUSTED = 1e5
"""Pixels that this expectation is worth."""
_HIGH = 10.0
"""Height from which what goes on over a few lines may be a small piece of surface."""
_BANDS, _FEW = 8, 3.0
"""Bands of the picture in which clutter is counted apart, and ridges by chance in one of them that
say as much of how it goes on as nothing known."""
_MAXIMA = 3.0
"""Times that noise makes more low maxima than clutter is expected to; what is beyond is clutter."""
_STAYS = 1e-3
"""Share of clutter that other frames show, too, which is expected before anything is known."""
_SAME = 1.5
"""Grains within which another frame shows the same ridge."""
_ENOUGH, _ALIKE = np.log(50.0), 4.0
"""Evidence of one scan line up to which it counts fully, and the lines over which clutter hangs
together, as a particle does: what is beyond counts as of so many lines at once."""


def learn_response_law(frames: Sequence[ScanLines], matched: MatchedFilter) -> Noise:
    """Estimate how a filter's answers scatter with the level around, where there is no stripe.

    Noise, texture, blocks of an encoder and rows with a noise of their own all answer, each width
    by its own strength. Most of a picture is no stripe, so that medians tell.

    Args:
        frames: Frames spread over the recording.
        matched: The filter, with the noise that pixels alone have: answers are no weaker.
    """
    every = max(_EVERY, math.ceil(sum(one.levels.size for one in frames) / _MOST_ANSWERS))
    parts = map_at_once(
        lambda lines: _answers(lines.binned(matched.binning), matched, every), frames
    )
    level, answer = (np.concatenate(column) for column in zip(*parts, strict=True))
    if len(level) < _FEWEST:
        return matched.noise
    order = np.argsort(level, kind="stable")
    bins = [
        (
            np.mean(level[part], dtype=float),
            (_GAUSSIAN * float(np.median(np.abs(answer[part])))) ** 2,
            len(part),
        )
        for part in np.array_split(order, min(_BINS, max(len(order) // _FEWEST, 1)))
    ]
    table = np.array(bins, float)
    # What is within a factor of two of the noise is counted as clutter, at its own heights.
    usual = np.average(table[:, 1] / matched.noise.variance(table[:, 0]), weights=table[:, 2])
    table[:, 1] /= np.clip(usual, 1.0, _TOLERATED)
    return fit_law(table, matched.noise)


def _answers(lines: ScanLines, matched: MatchedFilter, every: int) -> tuple[Ratios, Ratios]:
    """List the level around, and the answer, of some pixels that are not saturated."""
    signal, levels = (np.ascontiguousarray(one[:, ::every]) for one in (lines.signal, lines.levels))
    answers = score_pixels(signal, levels, matched.template, np.array([1.0, 0, 0, 1, 0]))
    half = len(matched.template) // 2
    inside = answers[half:-half]
    ends = (levels[: -2 * half], levels[2 * half :])
    around = 0.5 * (ends[0].astype(np.float32) + ends[1])
    dark = around < lines.white
    return around[dark], inside[dark]


def usual_rates() -> Rates:
    """Compute what clutter is expected before a recording is known; see `weigh_heights`."""
    return _USUAL * np.maximum(_HEIGHTS / _KNEE, 1.0) ** -_FALL


def learn_rates(
    ridges: Sequence[Ridges], posteriors: Sequence[Sequence[Float[np.ndarray, "_ _"]]]
) -> Rates:
    """Count the ridges that are no stripe, by height [1/px and e-fold].

    Low clutter that goes on over scan lines, as an encoder's blocks do, is counted as often as it
    does so beyond chance: each line of it tells no more.

    Args:
        ridges: Of frames spread over the recording.
        posteriors: Of each ridge being the stripe, of each laser.
    """
    counts, pixels = np.zeros(len(_HEIGHTS)), 0
    going, by_chance = np.zeros((2, _BANDS, len(_HEIGHTS)))
    for one, lasers in zip(ridges, posteriors, strict=True):
        other = _are_clutter(one, lasers)
        band, place = _bins(one, other)
        go_on, expected = one.go_on(other)
        counts += np.bincount(place, minlength=len(counts))
        np.add.at(going, (band, place), go_on[other])
        np.add.at(by_chance, (band, place), expected[other])
        pixels += one.lines.levels.size
    rates = (counts / _STEP + _TRUSTED * usual_rates()) / (pixels + _TRUSTED)
    # Low ones are the noise's own maxima, and stripes that were missed.
    low = np.maximum(usual_rates(), rates / _MAXIMA)
    rates = np.where(_HEIGHTS < _KNEE, low, rates)
    # A stripe too faint to be told goes on as well, but in some bands of the picture alone.
    clumps = np.maximum(np.median((going + _FEW) / (by_chance + _FEW), axis=0), 1.0)
    return rates * np.where(_HEIGHTS < _HIGH, clumps, 1.0)


def learn_stays(
    ridges: Sequence[Ridges], posteriors: Sequence[Sequence[Float[np.ndarray, "_ _"]]]
) -> Stays:
    """Measure which share of the clutter of each height other frames show in its place, too.

    Snow is gone by the next frame; blocks of an encoder, remnants of dirt and glare beside a bright
    stripe stay. Asked are those beside one, in the next scan line, that stays: a false line is made
    of them, and each of its lines tells no more than how often such a one stays as well.

    Args:
        ridges: Of frames spread over the recording.
        posteriors: Of each ridge being the stripe, of each laser.
    """
    staying, asked = np.zeros((2, _BANDS, len(_HEIGHTS)))
    for one, lasers, next_one in _followed(ridges, posteriors):
        other = _are_clutter(one, lasers)
        is_there = one.are_also_in(next_one, near=_SAME)
        other &= one.are_beside(other & is_there)
        chance = one.chance_of(next_one, near=_SAME)[other]
        np.add.at(staying, _bins(one, other), is_there[other] - chance)
        np.add.at(asked, _bins(one, other), 1.0 - chance)
    # A stripe too faint to be told stays as well, but in some bands of the picture alone.
    share = (np.maximum(staying, 0.0) + _FEW * _STAYS) / (asked + _FEW)
    stays = np.clip(np.median(share, axis=0), _STAYS, 1.0)
    return np.where(_HEIGHTS < _HIGH, stays, _STAYS)


def _followed(
    ridges: Sequence[Ridges], posteriors: Sequence[Sequence[Float[np.ndarray, "_ _"]]]
) -> Iterator[tuple[Ridges, Sequence[Float[np.ndarray, "_ _"]], Ridges]]:
    """Give each frame with its posteriors and the next one that has the same rows."""
    for number, (one, lasers) in enumerate(zip(ridges, posteriors, strict=True)):
        row = one.lines.frame.first_row
        for other in ridges[number + 1 :]:
            if other.lines.frame.first_row == row:
                yield one, lasers, other
                break


def _are_clutter(ridges: Ridges, lasers: Sequence[Float[np.ndarray, "_ _"]]) -> Marks:
    """Tell which ridges are neither a long stripe nor near one."""
    stripe = np.any([ridges.are_long(posterior > 0.5) for posterior in lasers], axis=0)
    return ridges.exist & ~stripe & ~ridges.are_within(stripe, ridges.reach)


def _bins(ridges: Ridges, which: Marks) -> tuple[Indices, Indices]:
    """Give the band of the picture and the bin of heights that each of some belongs to."""
    place = np.rint(np.log(ridges.heights[which] / _HEIGHTS[0]) / _STEP).astype(int)
    band = (_BANDS * ridges.positions[which] / len(ridges.lines.levels)).astype(int)
    return np.clip(band, 0, _BANDS - 1), np.clip(place, 0, len(_HEIGHTS) - 1)


def usual_stays() -> Stays:
    """Say which share of clutter is expected to stay before a recording is known."""
    return np.full(len(_HEIGHTS), _STAYS)


def bound_by_stays(
    said: Float[np.ndarray, "lines most"], heights: Float[np.ndarray, "lines most"], stays: Stays
) -> Float[np.ndarray, "lines most"]:
    """Bound what frames say for a ridge by the clutter that stays in them as a surface does.

    Args:
        said: Logarithm of the likelihood ratio against clutter that does not stay.
        heights: Of the ridges.
        stays: Share of the clutter that stays, by height; see `learn_stays`.
    """
    share = np.interp(np.log(np.maximum(heights, 1.0)), np.log(_HEIGHTS), stays)
    return -np.log(share + (1.0 - share) * np.exp(-said))


def weigh_heights(
    heights: Float[np.ndarray, "lines most"], rates: Rates
) -> Float[np.ndarray, "lines most"]:
    """Compute the likelihood ratio of each height, of a stripe against noise and clutter."""
    logs = np.log(np.maximum(heights, 1.0))
    clutter = np.exp(np.interp(logs, np.log(_HEIGHTS), np.log(rates)))
    # Local maxima of white noise through the filter, by their height (Rice 1945).
    noise = 0.55 * heights**2 * np.exp(-0.5 * heights**2)
    evidence = -np.log(noise + clutter)
    return np.exp(np.minimum(evidence, _ENOUGH + (evidence - _ENOUGH) / _ALIKE))
