"""Poses that no vehicle can have reached: lost fixes, zeros, jumps there and back."""

from dataclasses import dataclass

import numpy as np

from ..types.arrays import Mask, Points
from ..types.trajectory import Trajectory

_ACCELERATION = 20.0
"""What no vehicle in water reaches [m/s²]: twice that of a falling body."""
_SLACK = 0.02
"""What any log may jump by: its digits, and what a filter corrects at once [m]."""
_NOISE = 6.0
"""Deviations of the log's own noise that a step may differ from its neighbours."""
_WINDOW = 21
"""Steps whose median is the velocity at hand."""
_RETURNS = 10.0
"""How many times farther away an excursion is than the poses around it are from agreeing."""
_MOST_JUMPS = 8
"""Jumps within one excursion that are looked through: lost fixes may differ from each other."""


@dataclass(frozen=True)
class Excursion:
    """Poses in a row that are left out of a log."""

    begin: float
    """Time of the first of them [s]."""
    end: float
    """Time of the last of them [s]."""
    count: int
    """How many they are."""
    distance: float
    """How far they lie from where the vehicle was [m]."""


def leave_out_excursions(log: Trajectory) -> tuple[Trajectory, tuple[Excursion, ...]]:
    """Leave out poses to which the log jumps, and from which it comes back.

    A step is impossible where it differs from the velocity around it by more than 20 m/s² can do,
    and than the log's own noise. Between two such steps lies an excursion, if the poses before and
    after it agree with each other much better than with it. A log that begins or ends with zeros
    has not had a fix there. A jump that does not come back, such as a correction by a position
    from outside, stays.

    Args:
        log: Poses at their times.

    Returns:
        The poses that are left, and what is left out.
    """
    if len(log.times) < 3:
        return log, ()
    velocities = _running_median(np.diff(log.positions, axis=0) / np.diff(log.times)[:, None])
    edges = [0, *(np.flatnonzero(_is_impossible(log, velocities)) + 1).tolist(), len(log.times)]
    found = list[tuple[int, int, float]]()
    k = 0
    while k + 1 < len(edges) > 2:
        ends = edges[k + 1 : k + 1 + _MOST_JUMPS]
        astray = ((end, _distance(log, velocities, edges[k], end)) for end in ends)
        end, distance = next(((end, far) for end, far in astray if far is not None), (None, 0.0))
        if end is not None:
            found.append((edges[k], end, distance))
        k = k + 1 if end is None else edges.index(end)
        k += end is not None and 0 < end < len(log.times)  # what follows it is believed
    kept = np.ones(len(log.times), bool)
    for begin, end, _ in found:
        kept[begin:end] = False
    left = Trajectory(log.times[kept], log.positions[kept], log.quaternions[kept])
    return left, tuple(
        Excursion(float(log.times[begin]), float(log.times[end - 1]), end - begin, distance)
        for begin, end, distance in found
    )


def _is_impossible(log: Trajectory, velocities: Points) -> Mask:
    """Tell which steps differ from those around them by more than a vehicle can do."""
    spans = np.diff(log.times)
    away = np.linalg.norm(np.diff(log.positions, axis=0) - velocities * spans[:, None], axis=1)
    noise = 1.4826 * float(np.median(away))
    return away > _SLACK + _NOISE * noise + 0.5 * _ACCELERATION * spans**2


def _running_median(values: Points) -> Points:
    half = min(_WINDOW // 2, len(values) - 1)
    padded = np.pad(values, ((half, half), (0, 0)), mode="reflect")
    windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * half + 1, axis=0)
    return np.median(windows, axis=-1)


def _distance(log: Trajectory, velocities: Points, begin: int, end: int) -> float | None:
    """Tell how far poses from `begin` to before `end` are astray [m]; None where they are not."""
    places, last = log.positions, len(log.times)
    if begin == 0 or end == last:
        beside = places[end] if end < last else places[begin - 1]
        no_fix = not places[begin:end].any() and end - begin < last
        return float(np.linalg.norm(beside)) if no_fix else None
    before, after = places[begin - 1], places[end]
    moved = velocities[begin - 1] * (log.times[end] - log.times[begin - 1])
    away = min(np.linalg.norm(places[begin] - before), np.linalg.norm(places[end - 1] - after))
    apart = np.linalg.norm(after - before - moved)
    return float(away) if away > _RETURNS * apart + _SLACK else None
