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
    promised_end: float
    """When the file says it ends [s of the container]; -inf where it does not say."""

    @property
    def period(self) -> float:
        """Time between two pictures of the recording [s]; 1 where it has no times."""
        return 1 / self.rate if self.rate else self.spacing or 1.0

    def cut_period(self, apart: float) -> float:
        """Give the time that a picture's fields share [s], the next one being `apart` [s] away.

        A field is exposed half a period after the other whenever the next picture comes; only
        where that is early, by jitter, must the field come earlier too.
        """
        return min(apart, self.period)

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

    def count_missing(self, last: float) -> int:
        """Count the pictures that the file promises after its last one, at `last` [s]."""
        if not self.spacing or not math.isfinite(self.promised_end - last):
            return 0
        return max(round((self.promised_end - last) / self.spacing) - 1, 0)

    def number_of(self, container_time: float) -> int:
        """Give the number of the picture at a time of the container [s]."""
        return round((container_time - self.start) / self.spacing)


def usual_spacing(runs: Sequence[Sequence[float]]) -> float:
    """Give the median time between pictures that follow one another [s]; 0 where none is known."""
    steps = np.concatenate([np.diff(run) for run in runs] or [np.zeros(0)])
    steps = steps[np.isfinite(steps) & (steps > 0)]
    return float(np.median(steps)) if len(steps) else 0.0
