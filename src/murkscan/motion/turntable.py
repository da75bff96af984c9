"""An object that turns before a camera that stands still: the same as a camera that goes round."""

import numpy as np
import scipy

from ..errors import InputError
from ..types.arrays import Vector
from ..types.trajectory import Trajectory

_STEP = np.radians(0.1)
"""Largest turn from one pose to the next [rad]. Between poses positions are interpolated along the
chord: half a metre from the axis that is 0.2 µm off."""
_PAUSE = 0.25
"""Longest time between poses [s]: half of what a log is bridged over unless more is allowed."""
_MOST = 1_000_000
"""Poses of a log, at most."""


def turn_about_axis(
    point: Vector, direction: Vector, *, rate: float, duration: float
) -> Trajectory:
    """Give the camera's way around an object that turns about a fixed axis at a constant rate.

    The world turns with the object; at time 0 it is the camera's frame.

    Args:
        point: A point of the axis, in the camera's frame [m].
        direction: The axis, of any length; the object turns about it by the right hand.
        rate: How fast the object turns [rad/s]; negative for the other way.
        duration: How long [s].

    Raises:
        InputError: There is no direction, no turn or no time, or too many turns.
    """
    length = float(np.linalg.norm(direction))
    if not 0 < length < np.inf:
        raise InputError("The axis of a turntable needs a direction, such as 0,1,0.")
    if not 0 < abs(rate) < np.inf or not 0 < duration < np.inf:
        raise InputError(
            f"A turntable needs a turn and a time, got {np.degrees(rate):g} °/s for {duration:g} s."
        )
    count = int(np.ceil(duration * max(abs(rate) / _STEP, 1 / _PAUSE))) + 1
    if count > _MOST:
        raise InputError(
            f"A log of {np.degrees(abs(rate)) * duration / 360:,.0f} turns is too long; "
            "check the rate and the time."
        )
    times = np.linspace(0.0, duration, count)
    object_turned = rate * times[:, None] * np.asarray(direction) / length
    turn = scipy.spatial.transform.Rotation.from_rotvec(-object_turned)
    positions = point - turn.apply(point)
    return Trajectory(times, positions, turn.as_quat(scalar_first=True))
