"""Whether a ridge is rather an edge between bright and dark, which answers filters as well."""

from functools import lru_cache

import numpy as np
import scipy
from jaxtyping import Float32

from .._kernels.edges import answer_best
from ..types.arrays import Indices, Scalars
from .matched_filter import MatchedFilter, without_bend
from .scan_lines import ScanLines

_SHARP = 0.5
"""Blur of an edge as a share of the stripe's: the lens blurs both, the sheet is thick itself."""
_WIDTHS = (0.7, 1.0, 1.4)
"""Widths of the stripe that are tried, as a share of the learnt one: an octave in all."""
_OFF, _AWAY, _STEP = 0.5, 2.5, 0.25
"""Widths by which a stripe may lie beside its ridge, and an edge; and the step between trials."""
_UNEVEN = 40.0
"""Square of the score from which it is not noise that decides, but what surfaces look like. From 20
to 80 the fitted real sets hardly differ (benchmarks/real.py)."""


def weigh_edges(
    lines: ScanLines, matched: MatchedFilter, line: Indices, positions: Scalars, heights: Scalars
) -> Scalars:
    """Compute the logarithm of the likelihood ratio of stripes against edges, 0 at most.

    Both are fitted to the same pixels, on a background that may slope and bend, by least squares:
    what a template of norm 1 answers, squared, is what it explains. A stripe is weighed against
    edges by its own filter, so that the two flanks of a wide band are none.

    Args:
        lines: The frame.
        matched: The filter that found the ridges.
        line: Scan line of each ridge.
        positions: Where it is [px of the frame's image].
        heights: Its score [standard deviations].

    References:
        Kay, Fundamentals of Statistical Signal Processing: Detection Theory, 1998, section 6.4.2
        (the generalized likelihood ratio).
    """
    seen = lines.binned(matched.binning)
    templates, parts = _templates(matched.width, len(matched.template) // 2)
    places = np.rint(seen.from_image(positions)).astype(int)
    line = np.ascontiguousarray(line)  # loops are compiled anew for each layout
    stripe, edge = answer_best(seen.signal, line, places, templates, parts).T
    power = heights**2 / (1.0 + heights**2 / _UNEVEN)
    return np.minimum(0.5 * power * (1.0 - (edge / np.maximum(stripe, 1e-6)) ** 2), 0.0)


@lru_cache(maxsize=16)
def _templates(width: float, half: int) -> tuple[Float32[np.ndarray, "window _"], int]:
    """Make those of a stripe of a width [px], and of edges that make a ridge there, in columns.

    Gives how many of them are a stripe's, too.
    """
    x = np.arange(-half, half + 1.0)

    def tried(away: float) -> Scalars:
        return width * np.arange(-away, away + 0.5 * _STEP, _STEP)

    stripes = [np.exp(-0.5 * ((x - at) / (share * width)) ** 2) for at in tried(_OFF)
               for share in _WIDTHS]  # fmt: skip
    edges = [scipy.special.erf((x - at) / (np.sqrt(2) * _SHARP * width)) for at in tried(_AWAY)]
    columns = [without_bend(one) for one in (*stripes, *edges)]
    return np.stack(columns, axis=1), len(stripes)
