"""How the camera moves, while it moves and afterwards: the same flags, followed and read."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import InputError
from ..ui.values import read_start_time
from .options import MotionFlags

if TYPE_CHECKING:
    from ..io.dive.mavlink_link import MavlinkLink
    from ..io.pose_reading import PoseConvention
    from ..motion import AbstractMotion
    from ..motion.following import AbstractFollower
    from ..types.rig import Rig


def follow_mavlink(flags: MotionFlags, address: str | None, out: Path) -> MotionFlags:
    """Take what a vehicle sends for the log of a dive.

    Raises:
        InputError: Another log is given as well.
    """
    if address is None:
        return flags
    if flags.navigation is not None or flags.poses is not None:
        raise InputError("--mavlink is a log itself; leave out --poses and --navigation.")
    return replace(flags, navigation=out / "capture" / "navigation.tlog")


def open_link(address: str, flags: MotionFlags) -> "MavlinkLink":
    """Make what listens to a vehicle, and writes into the log of the dive."""
    from ..io.dive.mavlink_link import MavlinkLink

    assert flags.navigation is not None  # `follow_mavlink` says where
    return MavlinkLink(address, flags.navigation)


def make_follower(
    flags: MotionFlags, rig: "Rig", laser: int, link: "MavlinkLink | None"
) -> "Callable[[float], AbstractFollower]":
    """Make what follows the camera from the time at which its recording began.

    Args:
        flags: How it moves; where a vehicle is listened to, `navigation` is what that writes.
        rig: The rig.
        laser: Number of the laser.
        link: Listens to a vehicle.
    """

    def follow(began: float) -> "AbstractFollower":
        from ..io.growing_table import GrowingTable
        from ..motion import ConstantSpeed, ConstantStep
        from ..motion.following import LogFollower, SteadyFollower
        from ..motion.following_navigation import NavigationFollower, TableReadings
        from ..types.pose import Pose

        if flags.navigation is not None:
            return NavigationFollower(
                link or TableReadings(flags.navigation),
                rig,
                speed=None if flags.speed_mm_s is None else flags.speed_mm_s / 1e3,
                along=flags.along or rig.laser(laser).axis,
                crs=flags.crs,
                start_time=_start(flags, began) + flags.time_offset_s,
                gap=flags.gap_s,
            )
        if flags.poses is not None:
            return LogFollower(
                GrowingTable(flags.poses, "pose log"),
                _convention(flags),
                rig.vehicle_from_camera or Pose.identity(),
                start_time=_start(flags, began) + flags.time_offset_s,
                gap=flags.gap_s,
            )
        motion = flags.make(rig, laser)
        assert isinstance(motion, ConstantSpeed | ConstantStep)
        return SteadyFollower(motion)

    return follow


def make_mover(flags: MotionFlags, rig: "Rig", laser: int) -> "Callable[[float], AbstractMotion]":
    """Make the motion of the whole dive from the time at which its recording began."""

    def move(began: float) -> "AbstractMotion":
        if flags.poses is None and flags.navigation is None:
            return flags.make(rig, laser)
        return replace(flags, start_time=repr(_start(flags, began))).make(rig, laser)

    return move


def _convention(flags: MotionFlags) -> "PoseConvention":
    from ..io.pose_reading import PoseConvention

    said = (flags.log_time, flags.log_quaternion, flags.log_axes, flags.log_angles)
    return PoseConvention(*said)


def _start(flags: MotionFlags, began: float) -> float:
    """Find the log's time at which the recording began; a log's clock is this machine's."""
    if flags.start_time != "0":
        return read_start_time(flags.start_time)
    if flags.navigation is not None and flags.navigation.suffix == ".tlog":
        return began  # its packets are stamped since 1970
    from ..io.growing_table import GrowingTable
    from ..io.navigation_csv import read_measurements
    from ..io.pose_reading import read_poses
    from ..motion.following import is_clock

    if flags.poses is not None:
        file, convention = flags.poses, _convention(flags)
        table = GrowingTable(file, "pose log")
        clock = is_clock(table, lambda t: float(read_poses(file, t, convention).log.times[0]))
    else:
        assert flags.navigation is not None
        file = flags.navigation
        table = GrowingTable(file, "log of navigation")
        clock = is_clock(table, lambda t: float(read_measurements(file, t)[0].times[0]))
    return began if clock else 0.0
