"""Centres as a preview shows them: where the ridges are, without a fit to each."""

import math
from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from ..types.arrays import Indices, Scalars
from ..types.background import Noise, StripeShape
from .centres import Centres, learnt_of
from .matched_filter import SKIRT
from .ridges import Ridges
from .scan_lines import ScanLines

_GRID = 0.1
"""Pixels by which a parabola through a filter's answers has the place of a narrow stripe wrong,
1σ: against the fit, .04 to .09 px on hulls of 1.2 to .65 px (c = 1.5 and 3 /m)."""


def take_ridges(
    ridges: Ridges,
    posterior: Float[np.ndarray, "lines most"],
    *,
    noise: Noise,
    shapes: Sequence[StripeShape],
) -> Centres:
    """Take the ridges that are more probably the stripe than not for its centres.

    A parabola through a filter's answers has the place to a tenth of a pixel. A filter of norm 1
    answers a stripe of height A and width w with s = A √(√π w) / σ, and no estimate of its place
    has a smaller standard deviation than √2 w / s.

    References:
        Kay, Fundamentals of statistical signal processing: estimation theory, 1993, section 3.5
        (the bound for a signal's delay).
    """
    lines = ridges.lines
    line, which = np.nonzero(posterior > 0.5)
    at, shape = ridges.positions[line, which], ridges.shapes[line, which]
    # A white plateau's ridge lies in its middle, which is known to about a pixel.
    widths = np.array([each.width * each.binning for each in shapes] + [math.sqrt(0.5)])[shape]
    score = np.where(shape < 0, 1.0, ridges.heights[line, which])
    grid = _GRID * ridges.grains[line, which]
    sigma = lines.stretch * np.hypot(math.sqrt(2) * widths / score, grid)
    height = np.clip(_rises(lines, line, at, (1.0 + 2.0 * SKIRT) * widths), 1.0, noise.white)
    usual = learnt_of(lines, len(line), shapes[0])
    full = lines.as_full_frame(at)
    return Centres(lines, line, full, sigma, height, posterior[line, which], *usual)


def _rises(lines: ScanLines, line: Indices, at: Scalars, reach: Scalars) -> Scalars:
    """Compute how far the brightest pixel rises above the mean of both sides [grey levels]."""
    last = len(lines.levels) - 1

    def look(place: Scalars) -> Scalars:
        return lines.signal[np.clip(np.rint(place).astype(int), 0, last), line].astype(float)

    top = np.maximum.reduce([look(at - 1.0), look(at), look(at + 1.0)])
    return np.asarray(top - 0.5 * (look(at - reach) + look(at + reach)))
