"""A vehicle, an arm or a stage that logs where it is."""

import math
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import ClassVar, final

import numpy as np

from ..errors import InputError
from ..types.arrays import Mask, Scalars
from ..types.measured import Measured
from ..types.navigation import Navigation, NavigationAccuracy
from ..types.pose import Pose
from ..types.trajectory import Trajectory
from .base import AbstractMotion
from .errors import log_errors
from .excursions import Excursion, leave_out_excursions
from .measured import by_recording, measure_poses

_SAME = 1e-6
"""Difference below which two times are the same [s]: a clock since 1970 has no finer digits."""
_TOLD = 5
"""Spans of time that are told one by one."""


@final
@dataclass(frozen=True, eq=False)
class PoseLog(AbstractMotion):
    """The camera follows a log of poses, sampled at each frame's own time.

    Poses that no vehicle can have reached are left out (`leave_out_excursions`). Frames outside
    the log, or in a hole of it, have no pose.
    """

    log: Trajectory
    """Poses world_from_vehicle, at the log's own times."""
    vehicle_from_camera: Pose = field(default_factory=Pose.identity)
    """The mount; the identity where the log is of the camera itself."""
    start_time: float = 0.0
    """Log time at which recording time is 0 [s]."""
    time_offset: float = 0.0
    """Added to recording times [s], against a clock that runs ahead or behind."""
    gap: float = 0.5
    """Longest time between two poses that is bridged [s]."""

    stated: NavigationAccuracy | None = None
    """How good the vehicle's instruments are; None: nobody has said."""

    name: str = ""
    """What the log is called, for the record."""

    navigation: Navigation | None = None
    """The measurements that the poses were made from, by the same clock; None where the poses are
    themselves what was logged."""

    needs_times: ClassVar[bool] = True
    carries_mount: ClassVar[bool] = True

    @property
    def start(self) -> float:
        """See `AbstractMotion.start`."""
        return self.start_time + self.time_offset

    def __post_init__(self) -> None:
        """Refuse a clock that is no number."""
        if not math.isfinite(self.start_time + self.time_offset):
            raise InputError(
                f"The start time and the time offset must be numbers, got {self.start_time:g} and "
                f"{self.time_offset:g} s."
            )
        if not self.gap > 0:
            raise InputError(f"The longest gap that is bridged must be above 0, got {self.gap:g}.")

    @property
    def accuracy(self) -> str:
        """See `AbstractMotion.accuracy`."""
        if self.stated is None or self.stated == NavigationAccuracy():
            return ""
        return "the log is as good as [navigation] of the rig file says"

    def follow(self, times: Scalars, pictures: Scalars) -> Trajectory:
        """Give world_from_camera at the time of each frame; see `AbstractMotion.follow`."""
        log, _ = self._believed
        moments = times + (self.time_offset + self.start_time)
        covered = ~(self._is_outside(moments) | self._is_in_hole(moments))
        if 2 * int(covered.sum()) < len(times):
            raise InputError(self._say_uncovered(moments))
        # Rounding may have put the first and the last of them just outside.
        inside = np.clip(moments[covered], log.times[0], log.times[-1])
        poses = log.at(inside)
        if self.stated is not None:
            step = float(np.median(np.diff(log.times))) if len(log.times) > 1 else self.gap
            poses = replace(poses, errors=log_errors(poses, self.stated, step=step))
        return replace(poses.follow_mount(self.vehicle_from_camera), times=times[covered])

    def measure(self) -> Measured | None:
        """Give what was measured, where its accuracy is stated; see `AbstractMotion.measure`."""
        log, _ = self._believed
        navigation = self.navigation
        if navigation is None and self.stated is not None:
            navigation = measure_poses(log, self.stated)
        if navigation is None:
            return None
        return by_recording(navigation, self.start, self.vehicle_from_camera)

    def remarks(self, times: Scalars) -> tuple[str, ...]:
        """Tell which frames have no pose, and which poses are left out; see the base."""
        moments = times + (self.time_offset + self.start_time)
        _, excursions = self._believed
        outside, in_hole = self._is_outside(moments), self._is_in_hole(moments)
        poses = sum(excursion.count for excursion in excursions)
        told = [
            (outside, f"{outside.sum()} of {len(times)} frames lie outside the log of the poses"),
            (in_hole, f"{in_hole.sum()} of {len(times)} frames lie in holes of the log of the "
             f"poses that are longer than {self.gap:g} s"),
        ]  # fmt: skip
        lines = [
            f"{words} and are left out: {_say_spans(_runs(times, which))} of the recording"
            for which, words in told
            if which.any()
        ]
        if excursions:
            spans = [(one.begin, one.end) for one in excursions]
            far = max(one.distance for one in excursions)
            lines.append(
                f"{poses} poses of the log are left out, since no vehicle can have been there (up "
                f"to {far:.3g} m away): {_say_spans(spans)} by the log's clock"
            )
        return tuple(lines)

    @cached_property
    def _believed(self) -> tuple[Trajectory, tuple[Excursion, ...]]:
        return leave_out_excursions(self.log)

    def _is_outside(self, moments: Scalars) -> Mask:
        log, _ = self._believed
        return (moments < log.times[0] - _SAME) | (moments > log.times[-1] + _SAME)

    def _is_in_hole(self, moments: Scalars) -> Mask:
        """Tell which moments lie between two poses that are too far apart in time."""
        log, _ = self._believed
        after = np.clip(np.searchsorted(log.times, moments), 1, max(len(log.times) - 1, 1))
        begin, end = log.times[after - 1], log.times[np.minimum(after, len(log.times) - 1)]
        return (end - begin > self.gap) & (moments > begin + _SAME) & (moments < end - _SAME)

    def _say_uncovered(self, moments: Scalars) -> str:
        log, _ = self._believed
        in_hole = self._is_in_hole(moments)
        if 2 * int(in_hole.sum()) > len(moments):
            usual = float(np.median(np.diff(log.times)))
            return (
                f"The log {self.name} has a pose every {usual:.3g} s, and nothing is bridged over "
                f"more than {self.gap:g} s, so {in_hole.mean():.0%} of the frames have no pose. "
                "If the vehicle moves evenly enough between them, allow more with --gap-s."
            )
        covered = 1 - float((self._is_outside(moments) | in_hole).mean())
        return (
            f"The log {self.name} covers {covered:.0%} of the frames: they run from "
            f"{moments[0]:.3f} to {moments[-1]:.3f} s by its clock, but it runs from "
            f"{log.times[0]:.3f} to {log.times[-1]:.3f} s. Say with --start-time when the video "
            "began, or shift its clock with --time-offset-s."
        )


def _runs(times: Scalars, which: Mask) -> list[tuple[float, float]]:
    """Give the first and last time of each run of frames."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], which, [False]]).astype(np.int8)))
    return [(float(times[a]), float(times[b - 1])) for a, b in edges.reshape(-1, 2)]


def _say_spans(spans: list[tuple[float, float]]) -> str:
    words = [f"{a:.3f} s" if a == b else f"{a:.3f} to {b:.3f} s" for a, b in spans[:_TOLD]]
    more = f" and {len(spans) - _TOLD} more" if len(spans) > _TOLD else ""
    return ", ".join(words) + more
