"""How much centres scatter about a smooth surface: by noise, by the lens's blur, and beside."""

import math
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from ..types.arrays import Indices, Mask, Scalars
from ..types.background import StripeShape
from .pull import UNSURE, Pull

APART = (1, 2, 3)
"""Scan lines between centres that are compared: the nearer they are, the less do surfaces add; the
farther, the less noise do they share."""
_INNER = 6
"""Scan lines from where the stripe ends or jumps, beyond which nothing but noise scatters it."""
_BREAK = 2.0
"""Pixels from one scan line to the next, beside an even wall's slope, from which it jumps."""
THIRD = np.array([-1.0, 3.0, -3.0, 1.0])
"""Third difference of four centres: the slope and the bend of a smooth surface are none of it."""
JUMP = 1.3
"""The same, scaled to the scatter of one centre, from which a surface jumps [px]."""
_WALK = 1.28
"""Roughness of a surface that steps by chance, 1.21 of a step as `centres` counts it, as a multiple
of what third differences over 3 lines show of it, √0.9 of a step."""
_TOLD = 2.0
"""Standard deviations by which a pull exceeds its own noise, to tell of the blur."""
_TURNS = 10
"""Estimates of the blur, each with the weights that the last one gives."""
MEDIAN = 0.6745
"""Median size of a Gaussian's values, in standard deviations. Edges of a surface and of its paint
are a tail that says nothing of the rest: `join_centres` measures what they do where they are."""
ENOUGH = 100
"""Centres from which the shape is learnt, and from which three times as many its scatter."""

Bends = Float[np.ndarray, "m 7"]
"""Third differences of centres: the standard deviation of each that noise explains, and it; what a
blur of 1 px² adds to them, the standard deviation of that by noise, and of what is unknown of it
[px of the picture that is fitted]; scan lines from one centre to the next; and 1 where the stripe
goes on to both sides."""
Sizes = Float[np.ndarray, "_"]
"""Sizes of some third differences, more or fewer than of others."""


def third_differences(
    lines: Indices, centres: Scalars, straight: Scalars, sigma: Scalars, pull: Pull
) -> Bends:
    """Give how far centres should be off a parabola through others, and are, scaled to one centre.

    Second differences would take the bend of a ball, which often is the surest, for scatter.

    Args:
        lines: Scan line of each centre; they do not decrease.
        centres: Where they lie [px of the picture that is fitted].
        straight: The same from an even wall [px of the full frame].
        sigma: Their standard deviations [px of the picture that is fitted].
        pull: See `measure_pull` [px of the picture that is fitted].
    """
    is_inner = _are_inner(lines, straight)
    parts = [np.zeros((0, 7))]
    for apart in APART:
        wanted = lines[:, None] + apart * np.arange(len(THIRD))
        four = np.minimum(np.searchsorted(lines, wanted), len(lines) - 1)
        four = four[(lines[four] == wanted).all(axis=1)]
        columns = (
            _spread(sigma[four]),
            centres[four] @ THIRD,
            pull[four, 0] @ THIRD,
            _spread(pull[four, 1]),
            _spread(UNSURE * pull[four, 0]),
        )
        scaled = np.stack(columns, axis=1) / np.linalg.norm(THIRD)
        kind = np.stack([np.full(len(four), float(apart)), is_inner[four].all(axis=1)], axis=1)
        parts.append(np.hstack([scaled, kind])[np.abs(scaled[:, 1]) < JUMP])
    return np.concatenate(parts)


def _spread(sigma: Float[np.ndarray, "m 4"]) -> Scalars:
    """Compute the standard deviation of third differences."""
    return np.asarray(np.sqrt(sigma**2 @ THIRD**2))


def _are_inner(lines: Indices, straight: Scalars) -> Mask:
    """Tell which centres are far from where the stripe ends or jumps."""
    breaks = (np.diff(lines) != 1) | (np.abs(np.diff(straight)) > _BREAK)
    ends = np.concatenate([[0], np.flatnonzero(breaks) + 1, [len(lines)]])
    start, stop = (np.repeat(side, np.diff(ends)) for side in (ends[:-1], ends[1:]))
    number = np.arange(len(lines))
    return np.minimum(number - start, stop - 1 - number) >= _INNER


def with_scatter(shape: StripeShape, bends: Bends, *, widest: float) -> StripeShape:
    """Learn from third differences how the lens blurs the stripe, and what it scatters beside.

    Args:
        shape: The stripe, with its width.
        bends: Third differences of its centres.
        widest: The most that the lens may blur: the width of the stripe, at right angles to it, is
            that of the blur and of the sheet together [px of the full frame].
    """
    blur = min(_learn_blur(bends[bends[:, 5] == APART[-1]]), widest**2)
    inner = bends[bends[:, 6] > 0]
    if np.sum(inner[:, 5] == APART[-1]) > 3 * ENOUGH:
        bends = inner
    apart = [bends[:, 5] == each for each in APART]
    known, unknown = bends[:, 0], blur * np.hypot(bends[:, 3], bends[:, 4])
    noise, off = np.hypot(known, unknown), np.abs(bends[:, 1] - blur * bends[:, 2])
    misfit, floor, rough = _explain(np.stack([noise, off], axis=1)[apart[-1]])
    return replace(shape, misfit=misfit, floor=floor, blur=blur, rough=rough)


def _learn_blur(bends: Bends) -> float:
    """Estimate the blur along the stripe, misfits weighted down as Cauchy's law has them [px²].

    Where the pull is noise, it says nothing; where too little is told, there is none.
    """
    noise, off, drawn, unsure = bends[:, :4].T
    told = np.abs(drawn) > _TOLD * unsure
    if told.sum() < ENOUGH:
        return 0.0
    noise, off, drawn = noise[told], off[told], drawn[told]
    blur = 0.0
    for _ in range(_TURNS):
        weight = 1.0 / (noise**2 + (0.5 * (off - blur * drawn)) ** 2)
        blur = max(float(np.sum(weight * off * drawn) / np.sum(weight * drawn**2)), 0.0)
    return blur


def _explain(bends: Float[np.ndarray, "m 2"]) -> tuple[float, float, float]:
    """Give the factor and the floor with which half of the differences are as expected.

    The floor comes from the surest tenth, the factor from all that the floor does not rule. Last is
    the most that the floor may be, as far as noise lets it be seen.
    """
    if len(bends) <= 3 * ENOUGH:
        return 1.0, 0.0, 1.0
    bends = bends[np.argsort(bends[:, 0])]
    surest = bends[: max(len(bends) // 10, ENOUGH)]
    seen = (np.median(np.abs(surest[:, 1])) / MEDIAN) ** 2
    noise = np.median(surest[:, 0]) ** 2
    # What is seen is itself known to 2.6 / √n of it: less than twice that says nothing.
    hidden = 2.6 / math.sqrt(len(surest)) * noise
    floor = seen - noise if seen - noise > 2.0 * hidden else 0.0
    most = _WALK * math.sqrt(floor + hidden)
    rest = bends[bends[:, 0] ** 2 > 2.0 * floor]
    if len(rest) < 3 * ENOUGH:
        return 1.1, float(np.sqrt(floor)), most
    factor = np.median(np.abs(rest[:, 1]) / np.sqrt(rest[:, 0] ** 2 + floor)) / MEDIAN
    return float(np.clip(factor, 1.0, 3.0)), float(np.sqrt(floor)), most


def weighted_median(values: Scalars, weights: Scalars) -> float:
    """Compute the value below which half of the weight lies."""
    order = np.argsort(values)
    total = np.cumsum(weights[order])
    return float(values[order][np.searchsorted(total, 0.5 * total[-1])])
