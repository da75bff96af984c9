"""How a log's stated accuracy moves its poses: independent errors of the whole trajectory."""

from collections.abc import Iterator

import numpy as np
from jaxtyping import Float

from ..types.arrays import Scalars
from ..types.navigation import NavigationAccuracy
from ..types.trajectory import Trajectory

Modes = Float[np.ndarray, "n 6 m"]
"""As `Trajectory.errors`."""
Moves = Float[np.ndarray, "n 3 m"]
"""Their first or their second half."""

_WAVES = 3
"""Periods over which noise is spread, from twice a log's step to the scan's duration, each
with the same variance: two looks, however far apart, differ by about √2 of the noise."""

_UP = np.array([0.0, 0.0, 1.0])[:, None]


def log_errors(poses: Trajectory, accuracy: NavigationAccuracy, *, step: float) -> Modes | None:
    """Compute how the errors of a vehicle's log move its poses, each at one standard deviation.

    A bias is one error of the whole trajectory, a drift grows with time, a clock that is off takes
    the poses of another moment. Noise is a sum of waves, so that no mode stands for a single
    reading. Where no noise of positions is stated they count as summed up from velocities along the
    attitude: a velocity's bias grows to a drift, and an attitude that is off leads astray. Noise of
    velocities averages out, and turn rates are in no log of poses: both are not used.

    Args:
        poses: world_from_vehicle at the times of the frames; the world's z is vertical.
        accuracy: How good the vehicle's instruments are.
        step: Time from one pose of the log to the next [s].

    Returns:
        None where the accuracy says nothing about poses.
    """
    is_reckoned = not accuracy.position_noise
    turns = list(_of_attitude(poses, accuracy, step))
    found = [_join(shift, None) for shift in _of_position(poses, accuracy, step)]
    found += [_join(_lead_astray(poses, turn) if is_reckoned else None, turn) for turn in turns]
    if is_reckoned and accuracy.depth_noise:
        for modes in found:
            modes[:, 2] = 0.0  # a gauge holds it
    found += [_join(shift, None) for shift in _of_depth(poses, accuracy, step)]
    found = [modes for modes in (*found, *_of_clock(poses, accuracy)) if modes.any()]
    return np.concatenate(found, axis=2) if found else None


def _of_position(poses: Trajectory, accuracy: NavigationAccuracy, step: float) -> Iterator[Moves]:
    if level := accuracy.position_noise:
        for axis in np.eye(3)[: 2 if accuracy.depth_noise else 3]:
            yield _waves(poses.times, step)[:, None, :] * (level * axis)[:, None]
        return
    steps = np.diff(poses.times, prepend=poses.times[0])[:, None, None]
    yield accuracy.velocity_bias * np.cumsum(poses.attitudes.as_matrix() * steps, axis=0)
    if accuracy.speed:
        yield accuracy.speed * (poses.positions - poses.positions[0])[:, :, None]


def _of_depth(poses: Trajectory, accuracy: NavigationAccuracy, step: float) -> Iterator[Moves]:
    if depth := accuracy.depth_noise:
        yield _waves(poses.times, step)[:, None, :] * (depth * _UP)


def _of_attitude(poses: Trajectory, accuracy: NavigationAccuracy, step: float) -> Iterator[Moves]:
    axes, waves = poses.attitudes.as_matrix()[:, :, :2], _waves(poses.times, step)[:, None, :]
    yield accuracy.attitude_bias * axes
    if accuracy.attitude_noise:
        for axis in (0, 1):
            yield accuracy.attitude_noise * axes[:, :, axis, None] * waves
    if heading := accuracy.heading_noise or accuracy.attitude_noise:
        yield heading * _UP * waves
    yield accuracy.heading_drift * (poses.times - poses.times[0])[:, None, None] * _UP


def _lead_astray(poses: Trajectory, turns: Moves) -> Moves:
    """Sum up how far a vehicle is led by an attitude that is off."""
    steps = np.diff(poses.positions, axis=0, prepend=poses.positions[:1])
    return np.cumsum(np.cross(turns, steps[:, :, None], axis=1), axis=0)


def _of_clock(poses: Trajectory, accuracy: NavigationAccuracy) -> Iterator[Modes]:
    if len(poses.times) < 2:
        return
    velocity = np.gradient(poses.positions, poses.times, axis=0)[:, :, None]
    turns = poses.attitudes
    rates = (turns[1:] * turns[:-1].inv()).as_rotvec() / np.diff(poses.times)[:, None]
    rate = np.concatenate([rates, rates[-1:]])[:, :, None]
    since = (poses.times - poses.times[0])[:, None, None]
    for late in (accuracy.clock_offset, accuracy.clock_drift * since):
        yield _join(late * velocity, late * rate)


def _waves(times: Scalars, step: float) -> Float[np.ndarray, "n w"]:
    """Compute waves of which each moment has the variance 1 in total."""
    periods = np.geomspace(2 * step, max(float(np.ptp(times)), 2 * step), _WAVES)
    phases = 2 * np.pi * (times - times[0])[:, None] / periods
    return np.concatenate([np.cos(phases), np.sin(phases)], axis=1) / np.sqrt(_WAVES)


def _join(shift: Moves | None, turn: Moves | None) -> Modes:
    """Put what shifts a pose over what turns it; None does nothing."""
    some = shift if shift is not None else turn
    assert some is not None
    none = np.zeros_like(some)
    pair = (none if shift is None else shift, none if turn is None else turn)
    return np.concatenate(pair, axis=1)
