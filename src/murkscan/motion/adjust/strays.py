"""Stretches of a leg that was laid where its bumps do not lie on those of another."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from ...types.arrays import Mask
from .legs import Leg
from .pairs import Side, make_sides, measure_apart
from .relief import FLATTEST
from .rough import Tiles
from .solve import State
from .ties import Ties, measure_aside

SEAM = 20e-3
"""Distance up to which legs are looked for in each other's place [m]."""
_ROUGH = 3.0
"""Variance of heights, in that of their noise, below which rows do not tell on what they lie."""
_HERE = 4.0
"""Cells within which a tile lies where it was found."""
_ROW_FACETS = 5
"""Facets of a row that tell how it lies."""


@dataclass(frozen=True, eq=False)
class Overlap:
    """How one leg lies on another."""

    apart: Float[np.ndarray, " f"]
    """How far each facet lies in front of the other leg [m]."""
    times: Float[np.ndarray, " r"]
    """Of the rows that have relief to tell by [s]."""
    is_stray: Bool[np.ndarray, " r"]
    """Whether their bumps lie on other ones than their like."""


def compare_legs(a: Side, b: Side) -> Overlap:
    """Compare one leg with another where both lie on one another.

    Facets of two legs lie apart by the noise of both, and on other bumps by those of both, too: a
    row is a stray beyond a quarter of the way from the one mean square to the other.
    """
    apart, row = measure_apart(a, b, SEAM)
    noise, relief = _noise(a) + _noise(b), a.relief + b.relief
    if not len(apart) or relief <= max(2 * FLATTEST**2, _ROUGH * noise):
        return Overlap(apart, np.zeros(0), np.zeros(0, bool))
    count = np.bincount(row)
    square = np.bincount(row, apart**2) / np.maximum(count, 1)
    there = np.flatnonzero(count >= _ROW_FACETS)
    is_stray = square[there] >= noise + (relief - noise) / 4
    return Overlap(apart, a.facets.leg.row_times[there], is_stray)


def _noise(side: Side) -> float:
    """Give the variance of a leg's heights that is noise [m²]."""
    return float(np.mean(side.facets.variance / side.facets.count))


def drop_strays(tiles: Tiles, state: State, legs: Sequence[Leg]) -> Tiles:
    """Leave out tiles by which legs were laid where their bumps do not lie on their like.

    Another place looks like that of a tile now and then. Once facets have been paired, heights of
    the same bumps lie within their noise of one another; on other bumps they never do.

    Args:
        tiles: What was found.
        state: Where everything stands since facets have been paired.
        legs: All legs.
    """
    sides = make_sides(legs, state.paths) if tiles else []
    return {
        (i, j): ties[~_are_stray(ties, state, sides[i], sides[j])] for (i, j), ties in tiles.items()
    }


def _are_stray(ties: Ties, state: State, a: Side, b: Side) -> Mask:
    lies = compare_legs(a, b)
    if not (lies.is_stray.any() and len(ties)):
        return np.zeros(len(ties), bool)
    nearest = np.abs(lies.times - ties.time_a[::3, None]).argmin(axis=1)
    off = measure_aside(ties, state.paths)
    is_here = np.abs(off).max(axis=1) < _HERE * max(a.facets.leg.size, b.facets.leg.size)
    return np.repeat(lies.is_stray[nearest] & is_here, 3)
