"""From a log of measurements, alone or with a speed, to the motion of a scan."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from ..errors import InputError
from ..io.navigation_log import NavigationLog, read_navigation_log
from ..types.arrays import Vector
from ..types.navigation import Navigation, NavigationAccuracy
from ..types.pose import Pose
from ..types.rig import Rig
from ..types.trajectory import Trajectory
from ..types.water import Water
from .base import AbstractMotion, Direction
from .constant_speed import ConstantSpeed
from .measured import measure_along_attitude
from .pose_log import PoseLog
from .reckon import reckon


def follow_navigation(
    path: Path,
    rig: Rig,
    *,
    speed: float | None,
    sigma: float = ConstantSpeed.sigma,
    along: Direction,
    crs: str | None = None,
    start_time: float = 0.0,
    time_offset: float = 0.0,
    gap: float = 0.5,
) -> tuple[AbstractMotion, tuple[str, ...]]:
    """Make the motion of a scan from what a vehicle's instruments measured.

    With a speed the vehicle moves with it along the camera's axis, turned by the log's attitude,
    at its depth. Without, the log's poses are followed, or its velocities added up.

    Args:
        path: The log: an MCAP, a bag, a .tlog, NMEA, or CSV.
        rig: The rig; its mount says how the camera sits on the vehicle.
        speed: Speed of the camera along one of its axes [m/s]; None where the log tells.
        sigma: Standard deviation of that speed, as a share of it.
        along: The axis.
        crs: Coordinate system of latitude and longitude; UTM's zone unless given.
        start_time: Log time at which recording time is 0 [s].
        time_offset: Added to recording times [s].
        gap: Longest time between two poses that is bridged [s].

    Returns:
        The motion, and how the log was taken, in sentences.

    Raises:
        FormatError: The log holds nothing of use.
        InputError: It tells neither places nor velocity, and no speed is given.
        MissingDependency: What reads it is not installed.
    """
    salinity = (rig.water or Water()).salinity_psu
    log = read_navigation_log(path, crs=crs, salinity=salinity, gap=gap, accuracy=rig.navigation)
    said = [log.understood]
    if log.unused:
        said.append(f"not used: {', '.join(log.unused)}")
    mount = rig.vehicle_from_camera
    if speed is not None and log.navigation.attitude is None:
        said.append("the log has no attitude, so the camera moves straight on at the speed given")
        return ConstantSpeed(speed, along, sigma), tuple(said)
    if mount is None and log.poses is None:
        said.append(
            "the rig has no [mount]: its camera's x, y, z are taken for the vehicle's forward, "
            "starboard, down"
        )
    way = find_way(path, log, mount or Pose.identity(), speed, along, said)
    turn = (mount or Pose.identity()).rotation
    ahead = None if speed is None else speed * (turn @ np.eye(3)["xyz".index(along)])
    motion = PoseLog(
        way,
        mount or Pose.identity(),
        start_time,
        time_offset,
        gap,
        stated=_state(rig.navigation, speed=speed, sigma=sigma, is_placed=way is log.poses),
        name=str(path),
        navigation=_measure(log, rig.navigation, ahead, sigma),
    )
    return motion, tuple(said)


def _state(
    stated: NavigationAccuracy | None, *, speed: float | None, sigma: float, is_placed: bool
) -> NavigationAccuracy | None:
    """Say how good the poses are that were made from a log: reckoned places have other errors."""
    if speed is None and (stated is None or is_placed):
        return stated
    known = stated or NavigationAccuracy()
    if speed is None:
        return replace(known, position_noise=None, speed=None)
    return replace(known, position_noise=None, velocity_bias=0.0, speed=sigma or None)


def _measure(
    log: NavigationLog, stated: NavigationAccuracy | None, ahead: Vector | None, sigma: float
) -> Navigation | None:
    """Give what a scan may correct: measurements whose accuracy is stated, or a speed's."""
    measured = log.navigation
    if ahead is not None and measured.attitude is not None:
        return measure_along_attitude(measured, ahead, sigma) if sigma else None
    if stated is None:
        return None
    is_placed = measured.position is not None and stated.position_noise is not None
    is_led = measured.velocity is not None and stated.velocity_noise is not None
    return measured if is_placed or is_led else None


def find_way(
    path: Path,
    log: NavigationLog,
    mount: Pose,
    speed: float | None,
    along: Direction,
    said: list[str],
) -> Trajectory:
    """Find a vehicle's way in its log: its poses, or its velocity added up from 0.

    Args:
        path: The file of the log, for messages.
        log: What it tells.
        mount: vehicle_from_camera.
        speed: Speed of the camera along one of its axes [m/s]; None where the log tells.
        along: The axis.
        said: Is told how the log was taken, in sentences.

    Raises:
        InputError: It tells neither places nor velocity, and no speed is given.
    """
    if speed is not None:
        if log.poses is not None or log.navigation.velocity is not None:
            said.append("places and velocities of the log are not used, since a speed is given")
        axis = np.eye(3)["xyz".index(along)]
        return reckon(log.navigation, speed * (mount.rotation @ axis))
    if log.poses is not None:
        return log.poses
    if log.navigation.attitude is not None and log.navigation.velocity is not None:
        said.append("its velocities are added up along its attitude")
        return reckon(log.navigation)
    raise InputError(
        f"{path} tells how the vehicle turned and how deep it was, but neither where it was nor "
        "how fast; say about how fast with --speed-mm-s."
        if log.navigation.attitude is not None
        else f"{path} has no attitude, and no poses; say how fast the camera moved straight on "
        "with --speed-mm-s, or give a log of poses with --poses."
    )
