"""A vehicle's way from its attitude and its speed: dead reckoning."""

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.spatial.transform import Rotation

from ..errors import InputError
from ..types.arrays import Scalars, Vector
from ..types.navigation import Navigation, Readings
from ..types.trajectory import Trajectory

_SMOOTH = 0.3
"""Time over which a depth is smoothed, one standard deviation [s]: longer than between readings of
10 Hz, and short enough to keep nine tenths of a heave of four seconds."""
_EVEN = 0.05
"""Step of the times at which it is smoothed [s]."""


def reckon(navigation: Navigation, velocity: Vector | None = None) -> Trajectory:
    """Add up a vehicle's velocity along its attitude.

    A depth that was measured holds the third coordinate.

    Args:
        navigation: What was measured; it must have an attitude.
        velocity: Velocity along the vehicle's own axes that stays the same [m/s], in place of the
            measured one.

    Returns:
        world_from_vehicle at the times of the attitude, from 0 north and east at the first.

    Raises:
        InputError: There is no attitude, or neither velocity.
    """
    attitude, measured = navigation.attitude, navigation.velocity
    if attitude is None or (velocity is None and measured is None):
        raise InputError("Dead reckoning needs an attitude and a velocity.")
    times = attitude.times
    turns = Rotation.from_euler("ZYX", attitude.values[:, ::-1])
    if velocity is None and measured is not None:
        times, turns = _cut(times, turns, measured)
        own = np.stack([np.interp(times, measured.times, v) for v in measured.values.T], axis=1)
    else:
        own = np.tile(np.asarray(velocity, float), (len(times), 1))
    moving = turns.apply(own)
    steps = 0.5 * (moving[1:] + moving[:-1]) * np.diff(times)[:, None]
    places = np.vstack([np.zeros(3), np.cumsum(steps, axis=0)])
    if navigation.depth is not None:
        places[:, 2] = _hold_depth(times, places[:, 2], navigation.depth)
    return Trajectory(times, places, turns.as_quat(scalar_first=True))


def _cut(times: Scalars, turns: Rotation, measured: Readings) -> tuple[Scalars, Rotation]:
    """Keep what lies within the velocities."""
    inside = (times >= measured.times[0]) & (times <= measured.times[-1])
    if np.count_nonzero(inside) < 2:
        raise InputError("The log's attitudes and velocities are of different times.")
    return times[inside], turns[inside]


def _hold_depth(times: Scalars, reckoned: Scalars, depth: Readings) -> Scalars:
    """Give the reckoned depth its slow part from the gauge."""
    away = np.interp(times, depth.times, depth.values[:, 0]) - reckoned
    even = np.arange(times[0], times[-1] + _EVEN, _EVEN)
    slow = gaussian_filter1d(np.interp(even, times, away), _SMOOTH / _EVEN, mode="nearest")
    return reckoned + np.interp(times, even, slow)
