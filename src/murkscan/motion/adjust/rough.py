"""Rough ties between legs: tiles of one's relief that were found in another's."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np
from jaxtyping import Float

from ...types.arrays import Scalars
from .doubt import Doubt
from .draws import draw_errors
from .legs import Facets, Leg, leg_direction, make_facets
from .log_terms import Log
from .relief import Relief, make_relief
from .settings import AdjustSettings
from .solve import State, improve
from .ties import Ties, as_seen
from .tiles import tie_tiles

Tiles = dict[tuple[int, int], Ties]
"""Ties of tiles of one leg that were found in another, by the places of both among the legs."""
MORE = 1.05
"""Growth of the count of tiles that were found which is worth another look."""
_DRAWS = 24
"""Errors that are drawn to say how far tiles may lie from their place: σ to one part in seven."""


def lay_roughly(
    state: State,
    logs: Sequence[Log],
    legs: Sequence[Leg],
    known: Sequence[Ties],
    found: Tiles,
    settings: AdjustSettings,
    tell: Callable[[str], None],
    *,
    within: bool,
) -> tuple[State, Tiles]:
    """Tie tiles within passes, or between them, beside the ties that are known.

    It ends where no more tiles are found than in the round before; `found` are those that were
    found when the paths lay elsewhere, and are believed.
    """
    before = count_tiles(found)
    for _ in range(settings.rounds):
        errors = draw_errors(state, logs, [*known, *found.values()], settings, count=_DRAWS)
        reliefs = make_reliefs(legs, state, logs, errors)
        found = {
            (i, j): carry_to_vehicles(ties, state)
            for i, j in combinations(range(len(legs)), 2)
            if _are_to_meet(legs[i], legs[j], within=within)
            for ties, _ in tie_legs(reliefs[i], reliefs[j], state, errors, settings, logs)
        }
        count = count_tiles(found)
        tell(f"{count} tiles {'within' if within else 'between'} passes")
        state = improve(state, logs, [*known, *found.values()], settings, steps=6)
        if count <= MORE * before:
            break
        before = count
    return state, found


def make_reliefs(
    legs: Sequence[Leg], state: State, logs: Sequence[Log], errors: Float[np.ndarray, "u m"]
) -> list[Relief]:
    """Make the relief of each leg where its path lies."""
    found = []
    for leg in legs:
        path, own = state.paths[leg.number], logs[0].layout.of_path(leg.number, errors)
        found.append(make_relief(make_facets(leg, path), path, own))
    return found


def count_tiles(found: Tiles) -> int:
    """Count tiles: each has three ties."""
    return sum(map(len, found.values())) // 3


def _are_to_meet(a: Leg, b: Leg, *, within: bool) -> bool:
    """Tell whether tiles of one leg are looked for in another: between passes by one laser each."""
    return a.number == b.number if within else a.number != b.number and a.laser == b.laser


def tie_legs(
    a: Relief,
    b: Relief,
    state: State,
    errors: Float[np.ndarray, "u m"],
    settings: AdjustSettings,
    logs: Sequence[Log],
) -> list[tuple[Ties, Scalars]]:
    """Look for the tiles of one leg in another, where they may meet; see `tie_tiles`."""
    if not may_meet(a.facets, b.facets, settings.reach):
        return []
    leg, layout = a.facets.leg, logs[0].layout
    one, other = leg.number, b.facets.leg.number
    doubt = Doubt(
        state.paths[one], state.paths[other],
        layout.of_path(one, errors), layout.of_path(other, errors), settings.reach,
    )  # fmt: skip
    forward = np.tile(leg_direction(state.paths[one], leg.row_times), (len(leg.row_times), 1))
    return [tie_tiles(a, b, settings.tile, doubt, forward)]


def carry_to_vehicles(ties: Ties, state: State) -> Ties:
    """Carry both points from the world to the vehicles."""
    return replace(
        ties,
        point_a=as_seen(ties.pass_a, ties.time_a, ties.point_a, state.paths),
        point_b=as_seen(ties.pass_b, ties.time_b, ties.point_b, state.paths),
    )


def may_meet(a: Facets, b: Facets, reach: float) -> bool:
    """Tell whether the boxes about two legs meet."""
    if not (len(a) and len(b)):
        return False
    low = np.maximum(a.points.min(axis=0), b.points.min(axis=0))
    high = np.minimum(a.points.max(axis=0), b.points.max(axis=0))
    return bool(np.all(low <= high + reach))
