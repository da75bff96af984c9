"""Correct the ways of a vehicle by what its scans show of the same places.

The order: the logs alone; then tiles of one leg in another, first within each pass, where the log
errs least between the two looks, then between passes; then facets, paired anew after each step.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from jaxtyping import Float

from ...errors import InputError
from ...types.arrays import Mask, Scalars
from ...types.trajectory import Trajectory
from .checks import Seams, compare_passes, find_blind
from .draws import draw_errors
from .first_path import first_path, fit_path
from .legs import Leg, Pass, cut_legs
from .log_terms import Log
from .pairs import make_sides, pair_facets
from .path import Path
from .rough import MORE, Tiles, count_tiles, lay_roughly, may_meet
from .settings import AdjustSettings
from .solve import State, improve
from .strays import drop_strays
from .ties import Ties
from .unknowns import Layout
from .unrest import learn_unrest

_MODES = 64
"""Errors that are drawn to state the uncertainty: σ to one part in eleven."""
_FEW = 8
"""Errors that are drawn in a fine round: what they are asked is a mean over many moments."""
_ENOUGH = 5
"""Tiles that agree before two passes count as laid on one another to a bump's width."""
_BESIDE = 0.75
"""Time from a tile that was found up to which bumps lie on their like [s]: a vehicle keeps its
speed so long; tiles follow one another in less."""
_FULL, _ALL = 3, 10**9
"""Rounds at the end which take all facets."""
_SETTLED = 0.01e-3
"""Change of the paths (RMS) in a fine round at which it ends [m]."""


@dataclass(frozen=True, eq=False)
class Adjusted:
    """The ways of some passes, as their logs and what they saw together say."""

    paths: tuple[Path, ...]
    as_logged: tuple[Path, ...]
    """By the logs alone."""
    state: State
    logs: tuple[Log, ...]
    groups: tuple[Ties, ...]
    """The last ties, of each pair of legs."""
    errors: Float[np.ndarray, "u m"]
    """Independent errors of all unknowns, each of one standard deviation."""
    errors_as_logged: Float[np.ndarray, "u m"]
    """The same by the logs alone."""
    tiles: tuple[Ties, ...]
    """Three for each piece of surface that was found again elsewhere by its relief."""
    blind: float
    """Longest stretch of a pass [s] whose relief does not lie on its like when all is done: long,
    and the pass has settled wrongly."""
    seams: Seams
    """How far passes lie apart where they overlap, before and after."""
    astray: tuple[float, ...]
    """Of each pass the longest stretch [s] in which its relief is not that of another that it lies
    on."""

    def tiles_of(self, number: int) -> int:
        """Count the pieces of a pass's surface that were found again, in it or in another pass."""
        mine = [(ties.pass_a == number) | (ties.pass_b == number) for ties in self.tiles]
        return sum(int(one.sum()) for one in mine) // 3

    def trajectory(self, number: int, times: Scalars) -> Trajectory:
        """Compute world_from_vehicle of a pass, with its errors.

        Args:
            number: Of the pass.
            times: When [s], strictly increasing.
        """
        own = self.logs[number].layout.of_path(number, self.errors)
        return self.paths[number].as_trajectory(times, own)

    def trajectory_as_logged(self, number: int, times: Scalars) -> Trajectory:
        """Compute the same by the logs alone; the arguments are those of `trajectory`."""
        own = self.logs[number].layout.of_path(number, self.errors_as_logged)
        return self.as_logged[number].as_trajectory(times, own)

    def instrument_errors(self, number: int) -> dict[str, tuple[float, float]]:
        """Estimate the errors of a pass's instruments: biases, drifts, clock, the speed's factor.

        Returns:
            Of each that the log's accuracy leaves open: what was found, and its standard deviation,
            in m, s and rad.
        """
        found = {}
        for place, stated in self.logs[number].priors():
            if stated > 0:
                sigma = float(np.linalg.norm(self.errors[place]))
                name = self.logs[number].layout.name(place)
                found[name] = float(self.state.errors[place]), sigma
        return found


def adjust_passes(
    passes: Sequence[Pass],
    settings: AdjustSettings | None = None,
    *,
    tell: Callable[[str], None] = lambda words: None,
) -> Adjusted:
    """Correct the ways of passes over one object, in one world.

    Args:
        passes: Their profiles and logs.
        settings: What is taken for granted.
        tell: Is told what is being done.

    Raises:
        InputError: There is no pass, or one without profiles.
    """
    settings = settings or AdjustSettings()
    state, logs = _start(passes, settings)
    state = improve(state, logs, [], settings, steps=4)
    as_logged, loose = state.paths, draw_errors(state, logs, [], settings, count=_MODES)
    state = replace(state, paths=tuple(map(_lay, state.paths, passes)))
    legs = [
        leg
        for number, (one, path) in enumerate(zip(passes, state.paths, strict=True))
        for leg in cut_legs(number, one, path, settings.cell)
    ]
    apart = compare_passes(state, legs).apart
    groups: list[Ties] = []
    known: list[Ties] = []
    for within in (True, False)[: len(passes)]:
        rounds = settings.fine_rounds if not within or len(passes) == 1 else settings.inner_rounds
        state, logs, groups, tiles = _settle(
            state, logs, legs, known, settings, tell, rounds=rounds, within=within
        )
        known += tiles.values()
    errors = draw_errors(state, logs, groups, settings, count=_MODES, as_seen=True)
    blind, laid = find_blind(state, legs, logs, errors, settings), compare_passes(state, legs)
    scale = 1 / np.sqrt(_MODES)
    return Adjusted(
        state.paths, as_logged, state, logs, tuple(groups), scale * errors, scale * loose,
        tuple(known), blind, Seams(apart, laid.apart), laid.astray,
    )  # fmt: skip


def _settle(
    state: State,
    logs: tuple[Log, ...],
    legs: Sequence[Leg],
    known: Sequence[Ties],
    settings: AdjustSettings,
    tell: Callable[[str], None],
    *,
    rounds: int,
    within: bool,
) -> tuple[State, tuple[Log, ...], list[Ties], Tiles]:
    """Look for tiles and pair facets by turns, until no more tiles are found; see `_lay_finely`."""
    tiles: Tiles = {}
    groups: list[Ties] = []
    for cycle in range(settings.cycles):
        sound = drop_strays(tiles, state, legs)
        strays = count_tiles(tiles) - count_tiles(sound)
        if strays:
            tell(f"{strays} tiles do not lie on their like")
            state = improve(state, logs, [*known, *sound.values()], settings, steps=6)
        rough, found = lay_roughly(state, logs, legs, known, sound, settings, tell, within=within)
        if cycle and not strays and count_tiles(found) <= MORE * count_tiles(tiles):
            break
        tiles, ties = found, [*known, *found.values()]
        state, groups, logs = _lay_finely(
            rough, logs, legs, ties, settings, tell, rounds=rounds, within=within
        )
    return state, logs, groups, tiles


def _lay(path: Path, one: Pass) -> Path:
    """Lay a path where registration has laid its pass."""
    return path if one.start is None else fit_path(path, one.start)


def _start(passes: Sequence[Pass], settings: AdjustSettings) -> tuple[State, tuple[Log, ...]]:
    if not passes or any(len(one.times) < 2 for one in passes):
        raise InputError("An adjustment needs at least one pass, and two profiles in each.")
    paths = [
        first_path(
            one.navigation, float(one.times[0]), float(one.times[-1]), settings.knot_step, one.start
        )
        for one in passes
    ]
    layout = Layout.of(paths, [one.navigation.instruments for one in passes])
    begun: dict[int, float] = {}
    for one in passes:
        known = begun.setdefault(one.navigation.instruments, float(one.times[0]))
        begun[one.navigation.instruments] = min(known, float(one.times[0]))
    logs = tuple(
        _at_its_start(
            Log(number, one.navigation, layout,
                float(one.times[0]) - begun[one.navigation.instruments]),
            passes, settings,
        )
        for number, one in enumerate(passes)
    )  # fmt: skip
    return State(tuple(paths), np.zeros(layout.count)), logs


def _at_its_start(log: Log, passes: Sequence[Pass], settings: AdjustSettings) -> Log:
    """Say where a registered pass begins: the world itself begins with one of them at most."""
    start = passes[log.number].start
    if start is None:
        return log
    is_placed = any(
        one.navigation.position is not None and one.navigation.accuracy.position_noise
        for one in passes
    )
    if is_placed or log.number > 0:
        return replace(log, origin=start.positions[0], origin_sigma=settings.adrift)
    return replace(log, origin=start.positions[0])


def _matched(found: Sequence[Ties], a: Leg, b: Leg) -> Mask:
    """Tell in which rows of a leg its bumps are known to lie on those of another."""
    times = [
        t.time_a[::3]
        for t in found
        if len(t) and (t.pass_a[0], t.pass_b[0]) == (a.number, b.number)
    ]
    known = np.sort(np.concatenate([np.zeros(0), *times]))
    if len(known) < _ENOUGH:
        return np.zeros(len(a.row_times), bool)
    after = np.clip(np.searchsorted(known, a.row_times), 1, len(known) - 1)
    away = np.minimum(np.abs(known[after] - a.row_times), np.abs(known[after - 1] - a.row_times))
    near: Mask = away < _BESIDE
    return near


def _lay_finely(
    state: State,
    logs: tuple[Log, ...],
    legs: Sequence[Leg],
    found: Sequence[Ties],
    settings: AdjustSettings,
    tell: Callable[[str], None],
    *,
    rounds: int,
    within: bool,
) -> tuple[State, list[Ties], tuple[Log, ...]]:
    """Pair facets anew after each step, until nothing moves; within passes alone or all.

    Returns:
        Where everything lies, the last ties, and the logs with the unrest that was seen.
    """
    groups: list[Ties] = []
    errors = draw_errors(state, logs, found, settings, count=_FEW)
    for number in range(rounds):
        own = [log.layout.of_path(log.number, errors) for log in logs]
        sides = make_sides(legs, state.paths, own)
        reach = max(8e-3 / 2**number, 1e-3)
        most = settings.ties if number < rounds - _FULL else _ALL
        groups = [
            pair_facets(
                sides[i],
                sides[j],
                reach,
                most,
                bumps_match=_matched(found, legs[i], legs[j]),
            )
            for i, j in combinations(range(len(legs)), 2)
            if (legs[i].number == legs[j].number or not within)
            and may_meet(sides[i].facets, sides[j].facets, reach)
        ]
        if not groups:
            break
        before, state = state, improve(state, logs, groups, settings, steps=3)
        errors = draw_errors(state, logs, groups, settings, count=_FEW)
        logs = learn_unrest(state, logs, errors, settings)
        moved = _change(before, state)
        tell(f"fine round {number}: {sum(map(len, groups))} ties, moved {moved * 1e3:.3f} mm")
        if moved < _SETTLED:
            break
    return state, groups, logs


def _change(before: State, after: State) -> float:
    """Give how far the paths have moved, RMS [m]."""
    changes: list[Scalars] = []
    for one, two in zip(before.paths, after.paths, strict=True):
        times = np.linspace(one.knots.start, one.knots.end, 10 * one.knots.num_pieces)
        changes.append(np.linalg.norm(one.at(times).positions - two.at(times).positions, axis=1))
    return float(np.sqrt(np.mean(np.concatenate(changes) ** 2)))
