"""A vehicle, an arm or a stage that logs where it is."""

import math
from dataclasses import dataclass, field
from typing import ClassVar, final

from ..errors import InputError
from ..types.arrays import Scalars
from ..types.pose import Pose
from ..types.trajectory import Trajectory
from .base import AbstractMotion


@final
@dataclass(frozen=True, eq=False)
class PoseLog(AbstractMotion):
    """The camera follows a log of poses, sampled at each frame's own time."""

    log: Trajectory
    """Poses world_from_vehicle, at the log's own times."""
    vehicle_from_camera: Pose = field(default_factory=Pose.identity)
    """The mount; the identity where the log is of the camera itself."""
    start_time: float = 0.0
    """Log time at which recording time is 0 [s]."""
    time_offset: float = 0.0
    """Added to recording times [s], against a clock that runs ahead or behind."""

    name: str = ""
    """What the log is called, for the record."""

    needs_times: ClassVar[bool] = True

    def __post_init__(self) -> None:
        """Refuse a clock that is no number."""
        if not math.isfinite(self.start_time + self.time_offset):
            raise InputError(
                f"The start time and the time offset must be numbers, got {self.start_time:g} and "
                f"{self.time_offset:g} s."
            )

    def follow(self, times: Scalars, pictures: Scalars) -> Trajectory:
        """Give world_from_camera at the time of each frame; see `AbstractMotion.follow`."""
        try:
            sampled = self.log.at(times + self.time_offset + self.start_time)
        except InputError as error:
            raise InputError(
                f"{error} Say with --start-time when the video began, or shift its clock with "
                "--time-offset-s."
            ) from error
        poses = sampled.follow_mount(self.vehicle_from_camera)
        return Trajectory(times, poses.positions, poses.quaternions)
