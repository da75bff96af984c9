"""What the latest frames of a dive showed, and how fast they came."""

from collections import deque
from collections.abc import Sequence

import numpy as np

from ..types.trajectory import Trajectory
from .gauges import Look

_RECENT = 2.0
"""Recording time over which a gauge looks back [s]."""
_LATENCIES = 250
"""Frames over which the preview's delay is told."""
_SHARE = 95
"""Percent of them that keep it."""


class RecentLooks:
    """What the latest frames showed, and how fast they come."""

    def __init__(self) -> None:
        """Begin with nothing."""
        self._looks = deque[Look]()
        self._numbers = deque[int]()
        self._latencies = deque[float](maxlen=_LATENCIES)

    def add(self, look: Look, number: int, latency: float) -> None:
        """Take note of a frame.

        Args:
            look: What it showed.
            number: Its index in the recording.
            latency: Time from its arrival to its profile [s].
        """
        self._looks.append(look)
        self._numbers.append(number)
        self._latencies.append(latency)
        while self._looks[0].time < look.time - _RECENT:
            self._looks.popleft()
            self._numbers.popleft()

    @property
    def looks(self) -> Sequence[Look]:
        """Those of the latest two seconds, in order."""
        return list(self._looks)

    @property
    def latency(self) -> float | None:
        """Time from arrival to profile that 95 % of the latest frames kept [s]."""
        return float(np.percentile(self._latencies, _SHARE)) if self._latencies else None

    @property
    def rate(self) -> float | None:
        """Frames a second that come, also those that were dropped [1/s]."""
        span = self._looks[-1].time - self._looks[0].time if self._looks else 0.0
        return (self._numbers[-1] - self._numbers[0]) / span if span > 0 else None


def speed_of(way: Trajectory) -> float | None:
    """Compute the speed over a piece of a way [m/s]; None where it is a point."""
    span = float(way.times[-1] - way.times[0])
    steps = np.linalg.norm(np.diff(way.positions, axis=0), axis=1)
    return float(steps.sum()) / span if span > 0 else None
