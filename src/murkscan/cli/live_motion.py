"""How the camera moves, while it moves and afterwards: the same flags, followed and read."""

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from ..ui.values import read_start_time
from .options import MotionFlags

if TYPE_CHECKING:
    from ..io.pose_reading import PoseConvention
    from ..motion import AbstractMotion
    from ..motion.following import AbstractFollower
    from ..types.rig import Rig


def make_follower(
    flags: MotionFlags, rig: "Rig", laser: int
) -> "Callable[[float], AbstractFollower]":
    """Make what follows the camera from the time at which its recording began.

    Raises:
        InputError: The flags describe no motion.
    """
    flags.check()

    def follow(began: float) -> "AbstractFollower":
        from ..io.growing_table import GrowingTable
        from ..motion import ConstantSpeed, ConstantStep
        from ..motion.following import LogFollower, SteadyFollower
        from ..motion.following_navigation import NavigationFollower
        from ..types.pose import Pose

        if flags.navigation is not None:
            return NavigationFollower(
                GrowingTable(flags.navigation, "log of navigation"),
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
