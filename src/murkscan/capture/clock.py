"""What the times in a video's container mean for its frames."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Clock:
    """How a picture's number and its time in the container become the frame's time."""

    start: float
    """Time of the first picture in the container [s]."""
    spacing: float
    """Usual time between two pictures in the container [s]; 0 where it has no times."""
    rate: float | None
    """Pictures a second that replace the container's times, where the user gave them."""
    slack: int
    """By how many pictures a sound file may fall short of what its duration says."""

    @property
    def period(self) -> float:
        """Time between two pictures of the recording [s]; 1 where it has no times."""
        return 1 / self.rate if self.rate else self.spacing or 1.0

    @property
    def is_real(self) -> bool:
        """Whether times are seconds, not numbers of pictures."""
        return self.rate is not None or self.spacing > 0

    def time_of(self, number: int, container_time: float) -> float:
        """Give the time of a picture [s]; its number where the recording has no times."""
        if self.rate or not self.spacing:
            return number * self.period
        if math.isnan(container_time):
            return self.start + number * self.spacing
        return container_time

    def number_of(self, container_time: float) -> int:
        """Give the number of the picture at a time of the container [s]."""
        return round((container_time - self.start) / self.spacing)


def usual_spacing(runs: Sequence[Sequence[float]]) -> float:
    """Give the median time between pictures that follow one another [s]; 0 where none is known."""
    steps = np.concatenate([np.diff(run) for run in runs] or [np.zeros(0)])
    steps = steps[np.isfinite(steps) & (steps > 0)]
    return float(np.median(steps)) if len(steps) else 0.0
