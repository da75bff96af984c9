"""Whether an adjustment may be believed: does what was seen twice lie on its like?"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations, permutations

import numpy as np
from jaxtyping import Float

from ...types.arrays import Scalars
from .legs import Leg
from .log_terms import Log
from .pairs import make_sides
from .rough import carry_to_vehicles, make_reliefs, may_meet, tie_legs
from .settings import AdjustSettings
from .solve import State
from .strays import SEAM, compare_legs
from .ties import measure_aside

_ROW = 0.3
"""Time up to which tiles lie in one row, beside one another [s]."""


@dataclass(frozen=True)
class Seams:
    """How far passes lie apart where they overlap, RMS along the surface's normal [m]."""

    before: float
    """Where registration has laid them, as rigid bodies."""
    after: float
    """Where they have been adjusted to."""


@dataclass(frozen=True)
class Overlaps:
    """How passes lie on one another where they overlap."""

    apart: float
    """RMS of their distances along the surface's normal [m]."""
    astray: tuple[float, ...]
    """Of each pass the longest stretch [s] in which its relief is not that of another that it lies
    on."""


def compare_passes(state: State, legs: Sequence[Leg]) -> Overlaps:
    """Measure how far facets of different passes lie apart, and where bumps do not lie on bumps."""
    sides = make_sides(legs, state.paths) if len(state.paths) > 1 else []
    offs, astray = [np.zeros(0)], [0.0] * len(state.paths)
    for a, b in permutations(sides, 2):
        one, other = a.facets.leg.number, b.facets.leg.number
        if one == other or not may_meet(a.facets, b.facets, SEAM):
            continue
        lies = compare_legs(a, b)
        offs.append(lies.apart)
        longest = longest_without(lies.times, lies.times[~lies.is_stray])
        astray[one] = max(astray[one], longest)
    every = np.concatenate(offs)
    apart = float(np.sqrt(np.mean(every**2))) if len(every) else 0.0
    return Overlaps(apart, tuple(astray))


def find_blind(
    state: State,
    legs: Sequence[Leg],
    logs: Sequence[Log],
    errors: Float[np.ndarray, "u m"],
    settings: AdjustSettings,
) -> float:
    """Look for all tiles once more, nearby: how long there was relief, and nothing where it should.

    Returns:
        The longest stretch [s] in which tiles have relief and none of them lies on its like.
    """
    reliefs = make_reliefs(legs, state, logs, errors)
    exact = np.zeros((logs[0].layout.count, 1))
    blind = 0.0
    for i, j in combinations(range(len(legs)), 2):
        if legs[i].number == legs[j].number:
            for ties, times in tie_legs(reliefs[i], reliefs[j], state, exact, settings, logs):
                off = measure_aside(carry_to_vehicles(ties, state), state.paths)
                pitch = max(legs[i].size, legs[j].size)
                good = ties.time_a[::3][np.abs(off).max(axis=1, initial=0) < pitch]
                blind = max(blind, longest_without(np.unique(times), good))
    return blind


def longest_without(times: Scalars, good: Float[np.ndarray, " k"]) -> float:
    """Give the longest time between good ones, as far as there are others in between."""
    good = np.sort(good)
    near = np.diff(np.searchsorted(good, [times - _ROW, times + _ROW]), axis=0)[0] > 0
    bad = times[~near]
    which = np.searchsorted(good, bad)
    spans = [np.ptp(bad[which == number]) for number in np.unique(which)]
    return float(max(spans, default=0.0))
