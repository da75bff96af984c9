"""What a motion is known by: measurements with their accuracy, which a scan may correct."""

from dataclasses import replace

import numpy as np

from ..types.arrays import Vector
from ..types.measured import Measured
from ..types.navigation import Navigation, NavigationAccuracy, Readings
from ..types.pose import Pose
from ..types.trajectory import Trajectory

CLOCK = 0.5
"""Standard deviation of a log's clock of which nothing is stated [s]: recorders stamp pictures
when they arrive."""


def measure_speed(speed: float, sigma: float, axis: int) -> Measured | None:
    """Take a speed along a camera axis for a measurement; None where it is exact.

    Args:
        speed: Of the camera [m/s]; negative for the other way.
        sigma: Its standard deviation, as a share of it.
        axis: 0, 1, 2 for x, y, z.
    """
    if not sigma > 0:
        return None
    ahead = np.sign(speed) * np.eye(3)[axis]
    other = np.eye(3)[2 if axis != 2 else 1]
    vehicle_from_camera = np.stack([ahead, np.cross(other, ahead), other])
    navigation = Navigation(NavigationAccuracy(speed=sigma), speed=abs(speed))
    return Measured(navigation, Pose(vehicle_from_camera, np.zeros(3)), is_placed=False)


def measure_along_attitude(navigation: Navigation, velocity: Vector, sigma: float) -> Navigation:
    """Put a speed that is about known in place of measured velocities and places.

    It holds at all times of the recording, whatever the log's clock and wherever the log ends.

    Args:
        navigation: What was measured beside.
        velocity: Along the vehicle's own axes [m/s].
        sigma: Standard deviation of its mean, as a share of it.
    """
    speed = float(np.linalg.norm(velocity))
    x, y, z = (float(part) / speed for part in velocity)
    accuracy = replace(navigation.accuracy, velocity_noise=None, position_noise=None, speed=sigma)
    return replace(
        navigation, accuracy=accuracy, velocity=None, position=None, speed=speed, course=(x, y, z)
    )


def measure_poses(log: Trajectory, accuracy: NavigationAccuracy) -> Navigation | None:
    """Take a log of poses for measurements; None where its accuracy says nothing of places.

    Without noise of positions stated they count as summed up from velocities along the attitude.
    """
    turns = log.attitudes
    attitude = Readings(log.times, turns.as_euler("ZYX")[:, ::-1])
    navigation = Navigation(
        accuracy, attitude=attitude, depth=Readings(log.times, log.positions[:, 2:])
    )
    if accuracy.position_noise:
        return replace(navigation, position=Readings(log.times, log.positions))
    if not accuracy.velocity_noise or len(log.times) < 2:
        return None
    steps = np.diff(log.positions, axis=0) / np.diff(log.times)[:, None]
    middles = (log.times[1:] + log.times[:-1]) / 2
    attitudes = log.at(middles).attitudes
    return replace(navigation, velocity=Readings(middles, attitudes.inv().apply(steps)))


def by_recording(navigation: Navigation, start: float, mount: Pose) -> Measured:
    """Count a log's times by the recording's clock, and its places from the first one.

    Args:
        navigation: What was measured, by the log's clock.
        start: What the log's clock shows when recording time is 0 [s].
        mount: vehicle_from_camera.
    """
    origin = np.zeros(3)
    if navigation.position is not None and len(navigation.position):
        origin = navigation.position.values[0]
    accuracy = navigation.accuracy
    if not accuracy.clock_offset:
        accuracy = replace(accuracy, clock_offset=CLOCK)
    moved = replace(navigation, accuracy=accuracy).moved(seconds=-start, shift=-origin)
    return Measured(moved, mount, is_placed=True, origin=origin)
