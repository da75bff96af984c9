"""The clocks of a dive: steps of the recorder's, and times from stamps of arrival."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Int
from scipy.ndimage import median_filter, uniform_filter1d

from ...types.arrays import Scalars

_STEP = 0.1
"""Fall of the times of messages, as written one after another, that is a step of the clock [s]:
writers of several threads mix up less."""
_JUMP = 0.3
"""Change against another clock that is a step [s]: messages come late, but not all of them."""
_LOOK = 10
"""Messages that must agree on a step: a single one may be late."""
_WINDOW = 51
"""Messages over which times of arrival are smoothed: 2 s of video, 5 s of a log at 10 Hz."""
_EVEN = 0.1
"""Share of the usual step up to which times are as even as a camera's own."""
_HOLE = 5.0
"""Steps of the usual length that make a hole; shorter ones may be jitter."""

Ticks = Int[np.ndarray, "..."]


@dataclass(frozen=True)
class ClockStep:
    """A step of the recorder's clock, which is taken out."""

    message: int
    """Number of the first message after it, of all."""
    time: float
    """Time of the last message before it [s since 1970], all steps before taken out."""
    size: float
    """By how much the clock was put forward [s]; negative: back."""


def find_steps_back(log: Ticks) -> list[tuple[int, float]]:
    """Find where the clock of messages in the order of writing steps back.

    Args:
        log: Times of all messages [ns].

    Returns:
        Number of the first message after each step, and its size [s], which is negative: such that
        the time goes on by the usual step there.
    """
    steps = list[tuple[int, float]]()
    for i in (np.flatnonzero(np.diff(log) < -_STEP * 1e9) + 1).tolist():
        before, after = log[max(i - _LOOK // 2, 0) : i], log[i : i + _LOOK]
        if (steps and i < steps[-1][0] + _LOOK) or after.max() > np.median(before) - _STEP * 1e9:
            continue
        usual = float(np.median(np.diff(log[max(i - 100, 0) : i]))) if i > 1 else 0.0
        steps.append((i, (float(log[i] - log[i - 1]) - usual) / 1e9))
    return steps


def find_jumps(log: Ticks, messages: Ticks, other: Scalars) -> list[tuple[int, float]]:
    """Find where the clock of messages jumps against another one that some of them carry.

    Args:
        log: Times of all messages [ns], without the steps that are known.
        messages: Numbers of those that carry the other clock's time.
        other: That time [s], such as since the autopilot was switched on.

    Returns:
        As `find_steps_back`, of either sign.
    """
    offsets = (log[messages] - log[messages[0]]) / 1e9 - other
    jumps = list[tuple[int, float]]()
    for k in (np.flatnonzero(np.abs(np.diff(offsets)) > 0.8 * _JUMP) + 1).tolist():
        size = float(np.median(offsets[k : k + 7]) - np.median(offsets[max(k - 7, 0) : k]))
        inside = np.diff(log[messages[k - 1] : messages[k] + 1]) / 1e9
        j = int(np.argmax(np.abs(inside)))
        # A switched-off autopilot begins its own clock anew: then the log's own does not jump.
        if abs(size) > _JUMP and abs(inside[j] - size) < 0.5 * abs(size):
            jumps.append((int(messages[k - 1]) + j + 1, size))
    return jumps


def refine_steps(
    steps: Sequence[tuple[int, float]], log: Ticks, messages: Ticks, other: Scalars
) -> list[tuple[int, float]]:
    """Measure steps that are known against another clock: by medians, which no late message moves.

    Args:
        steps: As `find_steps_back` gives them.
        log: Times of all messages [ns], steps and all.
        messages: Numbers of those that carry the other clock's time.
        other: That time [s].
    """
    offsets = (log[messages] - log[messages[0]]) / 1e9 - other
    refined = list[tuple[int, float]]()
    for message, size in steps:
        at = int(np.searchsorted(messages, message))
        before, after = offsets[max(at - _WINDOW // 2, 0) : at], offsets[at : at + _WINDOW // 2]
        better = float(np.median(after) - np.median(before)) if len(before) and len(after) else size
        # Where the other clock began anew as well, it tells nothing.
        refined.append((message, better if abs(better - size) < _JUMP else size))
    return refined


def take_out(log: Ticks, steps: Sequence[tuple[int, float]]) -> Ticks:
    """Give times [ns] without steps."""
    mended = log.copy()
    for message, size in steps:
        mended[message:] -= round(size * 1e9)
    return mended


def time_by_other(arrival: Scalars, other: Scalars) -> Scalars:
    """Give times of arrival without their jitter, by another clock that messages carry [s].

    The offset of the two clocks is the running median of what arrival says; the mean delay stays.
    """
    offsets = arrival - other
    line = np.polynomial.Polynomial.fit(other, offsets, 1)(other) if len(other) > 2 else offsets
    return other + line + median_filter(offsets - line, min(_WINDOW, len(other)), mode="nearest")


def smooth_arrival(arrival: Scalars) -> tuple[Scalars, float]:
    """Smooth times of arrival of pictures that a camera takes evenly.

    Between holes the times follow the running mean of arrival against the number. Times that are
    even already stay as they are.

    Returns:
        The times [s], and the jitter that was taken out, one standard deviation [s]; 0 where none.
    """
    if len(arrival) < _WINDOW:
        return arrival, 0.0
    usual = float(np.median(np.diff(arrival)))
    cuts = np.flatnonzero(np.diff(arrival) > _HOLE * max(usual, 1e-9)) + 1
    pieces = [_smooth(piece) for piece in np.split(arrival, cuts)]
    smooth = np.concatenate(pieces)
    jitter = float(np.std(arrival - smooth))
    return (smooth, jitter) if jitter > _EVEN * usual else (arrival, 0.0)


def _smooth(arrival: Scalars) -> Scalars:
    if len(arrival) < 3:
        return arrival
    numbers = np.arange(len(arrival), dtype=float)
    line = np.polynomial.Polynomial.fit(numbers, arrival, 1)(numbers)
    width = min(_WINDOW, len(arrival))
    return line + uniform_filter1d(arrival - line, width, mode="reflect")
