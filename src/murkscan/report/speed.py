"""How fast the camera went, and how fast it may go for the wanted spacing."""

from dataclasses import dataclass

import numpy as np

from ..types.frame_times import FrameTimes
from ..types.trajectory import Trajectory
from .quantiles import Quantiles


@dataclass(frozen=True)
class Speed:
    """Speed of the camera against what the spacing needs."""

    rate: float | None
    """Frames a second, fields counted; None where the recording has no times."""
    step: Quantiles
    """Way from frame to frame [m]."""
    shown: Quantiles
    """Speed from frame to frame [m/s]; of no numbers where the recording has no times."""
    wanted: float | None
    """Wanted distance from one profile to the next [m]; None without any."""

    @property
    def highest(self) -> float | None:
        """Speed at which profiles lie as far apart as wanted [m/s]."""
        return None if self.rate is None or self.wanted is None else self.rate * self.wanted

    @property
    def needed_rate(self) -> float | None:
        """Frames a second that the speed of the scan would need [1/s]."""
        if self.wanted is None or self.shown.median is None:
            return None
        return self.shown.median / self.wanted


def judge_speed(
    frames: FrameTimes, trajectory: Trajectory, *, is_timed: bool, wanted: float | None
) -> Speed | None:
    """Measure the camera's speed over the frames; None where there are fewer than two.

    Args:
        frames: The frames that were read.
        trajectory: world_from_camera.
        is_timed: Whether the frames' times are seconds.
        wanted: Wanted distance from one profile to the next [m].
    """
    if len(frames) < 2:
        return None
    positions = trajectory.at(frames.time).positions
    ways = np.linalg.norm(np.diff(positions, axis=0), axis=1)
    counts = np.diff(frames.frame.astype(np.int64))
    times = np.diff(frames.time)
    nothing = np.zeros(0)
    return Speed(
        rate=float(np.median(counts / times)) or None if is_timed else None,
        step=Quantiles.from_values(ways / counts),
        shown=Quantiles.from_values(ways / times if is_timed else nothing),
        wanted=wanted,
    )
