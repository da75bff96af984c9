"""Where the camera is while it moves: a speed, or a log that grows."""

import abc
import math
from collections.abc import Callable
from typing import final

import numpy as np

from ..errors import FormatError
from ..io.growing_table import GrowingTable
from ..io.pose_reading import PoseConvention, read_poses
from ..io.text_table import TextTable
from ..types.arrays import Scalars
from ..types.pose import Pose
from ..types.trajectory import Trajectory
from .constant_speed import ConstantSpeed
from .constant_step import ConstantStep

_KEPT = 60.0
"""Time for which poses of a log are kept [s]; frames wait for theirs a second or two."""
_SINCE_1970 = 1e8
"""Times of a log above this are of a clock, and below it of a recording [s]."""


class AbstractFollower(abc.ABC):
    """Poses of a camera that is still under way."""

    @abc.abstractmethod
    def refresh(self) -> None:
        """Take note of what has come.

        Raises:
            FormatError: The log is none.
        """

    @property
    @abc.abstractmethod
    def known_until(self) -> float:
        """Recording time up to which poses are known [s]; -inf where none are."""

    @property
    @abc.abstractmethod
    def known_from(self) -> float:
        """Recording time from which poses are known [s]; inf where none are."""

    @abc.abstractmethod
    def follow(self, times: Scalars, pictures: Scalars) -> Trajectory | None:
        """Compute world_from_camera at those of some times at which it is known.

        Args:
            times: Recording times [s], strictly increasing.
            pictures: Number of the recorded picture of each; its second field is at half.

        Returns:
            The poses; None where not one is known.
        """


@final
class SteadyFollower(AbstractFollower):
    """A camera that keeps its speed, or its step."""

    def __init__(self, motion: ConstantSpeed | ConstantStep) -> None:
        """Follow a motion that needs no log."""
        self._motion = motion
        self._start: tuple[float, float] | None = None

    def refresh(self) -> None:
        """See `AbstractFollower.refresh`."""

    @property
    def known_until(self) -> float:
        """See `AbstractFollower.known_until`."""
        return math.inf

    @property
    def known_from(self) -> float:
        """See `AbstractFollower.known_from`."""
        return -math.inf

    def follow(self, times: Scalars, pictures: Scalars) -> Trajectory | None:
        """See `AbstractFollower.follow`; the first time ever asked for is the way's beginning."""
        if len(times) == 0:
            return None
        if self._start is None:
            self._start = float(times[0]), float(pictures[0])
        has_start = self._start[0] < times[0]
        way = self._motion.follow(
            np.concatenate([[self._start[0]], times]) if has_start else times,
            np.concatenate([[self._start[1]], pictures]) if has_start else pictures,
        )
        return way.at(times)


class AbstractLogFollower(AbstractFollower):
    """A camera on a vehicle whose log grows; subclasses are final, and add to the log."""

    def __init__(self, vehicle_from_camera: Pose, *, start_time: float, gap: float) -> None:
        """Begin with an empty log; the arguments as of `LogFollower`."""
        self._mount, self._start, self._gap = vehicle_from_camera, start_time, gap
        self._log: Trajectory | None = None

    @property
    def known_until(self) -> float:
        """See `AbstractFollower.known_until`."""
        return -math.inf if self._log is None else float(self._log.times[-1]) - self._start

    @property
    def known_from(self) -> float:
        """See `AbstractFollower.known_from`."""
        return math.inf if self._log is None else float(self._log.times[0]) - self._start

    def follow(self, times: Scalars, pictures: Scalars) -> Trajectory | None:
        """See `AbstractFollower.follow`."""
        log, moments = self._log, times + self._start
        if log is None or len(log.times) < 2:
            return None
        after = np.clip(np.searchsorted(log.times, moments), 1, len(log.times) - 1)
        covered = (moments >= log.times[0]) & (moments <= log.times[-1])
        covered &= log.times[after] - log.times[after - 1] <= self._gap
        if not covered.any():
            return None
        poses = log.at(moments[covered]).follow_mount(self._mount)
        return Trajectory(times[covered], poses.positions, poses.quaternions)


@final
class LogFollower(AbstractLogFollower):
    """A log of poses that another program writes on, line by line."""

    def __init__(
        self,
        table: GrowingTable,
        convention: PoseConvention,
        vehicle_from_camera: Pose,
        *,
        start_time: float,
        gap: float,
    ) -> None:
        """Follow a log.

        Args:
            table: The file.
            convention: What it does not say by itself.
            vehicle_from_camera: The mount.
            start_time: Log time at which recording time is 0 [s].
            gap: Longest time between two poses that is bridged [s].
        """
        super().__init__(vehicle_from_camera, start_time=start_time, gap=gap)
        self._table, self._convention = table, convention

    def refresh(self) -> None:
        """See `AbstractFollower.refresh`; poses that do not follow the last one are passed over."""
        table = self._table.read_new()
        if table is None or not table.rows:
            return
        self._log = go_on(self._log, read_poses(self._table.path, table, self._convention).log)


def go_on(log: Trajectory | None, new: Trajectory) -> Trajectory:
    """Put what is new of a log after what was there, of which the last minute is kept."""
    if log is None:
        return new
    later = new.times > log.times[-1]
    recent = log.times > log.times[-1] - _KEPT
    parts = [_pick(log, recent), _pick(new, later)]
    return Trajectory.concatenate([part for part in parts if part is not None])


def _pick(log: Trajectory, which: np.ndarray) -> Trajectory | None:
    if not which.any():
        return None
    return Trajectory(log.times[which], log.positions[which], log.quaternions[which])


def is_clock(table: GrowingTable, begin_of: Callable[[TextTable], float]) -> bool:
    """Tell whether a log's times are those of a clock: seconds since 1970, not since its begin.

    Args:
        table: The file.
        begin_of: Gives the first time of its lines [s].

    Raises:
        FormatError: It holds nothing yet, so that nobody can tell.
    """
    rows = table.read_new()
    if rows is None or not rows.rows:
        raise FormatError(
            f"{table.path} holds nothing yet; start what writes it first, or say with --start-time "
            "when the recording begins by its clock."
        )
    table.rewind()
    return bool(begin_of(rows) > _SINCE_1970)
