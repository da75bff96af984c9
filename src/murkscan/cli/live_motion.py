"""How the camera moves, while it moves and afterwards: the same flags, followed and read."""

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from ..errors import InputError
from ..ui.values import read_start_time
from .options import MotionFlags

if TYPE_CHECKING:
    from ..io.growing_table import GrowingTable
    from ..io.pose_reading import PoseConvention
    from ..motion import AbstractMotion
    from ..motion.following import AbstractFollower
    from ..types.rig import Rig


def make_follower(
    flags: MotionFlags, rig: "Rig", laser: int
) -> "Callable[[float], AbstractFollower]":
    """Make what follows the camera from the time at which its recording began.

    Raises:
        InputError: The flags describe no motion that can be followed.
    """
    flags.check()
    if flags.navigation is not None:
        raise InputError(
            "A dive follows --speed-mm-s, --step-mm or --poses; give the log of measurements to "
            "`murkscan scan` on its recording."
        )

    def follow(began: float) -> "AbstractFollower":
        from ..motion import ConstantSpeed, ConstantStep
        from ..motion.following import LogFollower, SteadyFollower
        from ..types.pose import Pose

        if flags.poses is None:
            motion = flags.make(rig, laser)
            assert isinstance(motion, ConstantSpeed | ConstantStep)
            return SteadyFollower(motion)
        table, convention = _open(flags)
        return LogFollower(
            table,
            convention,
            rig.vehicle_from_camera or Pose.identity(),
            start_time=_start(flags, began) + flags.time_offset_s,
            gap=flags.gap_s,
        )

    return follow


def make_mover(flags: MotionFlags, rig: "Rig", laser: int) -> "Callable[[float], AbstractMotion]":
    """Make the motion of the whole dive from the time at which its recording began."""

    def move(began: float) -> "AbstractMotion":
        if flags.poses is None:
            return flags.make(rig, laser)
        return replace(flags, start_time=repr(_start(flags, began))).make(rig, laser)

    return move


def _open(flags: MotionFlags) -> "tuple[GrowingTable, PoseConvention]":
    from ..io.growing_table import GrowingTable
    from ..io.pose_reading import PoseConvention

    assert flags.poses is not None
    said = (flags.log_time, flags.log_quaternion, flags.log_axes, flags.log_angles)
    return GrowingTable(flags.poses, "pose log"), PoseConvention(*said)


def _start(flags: MotionFlags, began: float) -> float:
    """Find the log's time at which the recording began; a log's clock is this machine's."""
    from ..motion.following import is_clock

    if flags.start_time != "0":
        return read_start_time(flags.start_time)
    return began if is_clock(*_open(flags)) else 0.0
