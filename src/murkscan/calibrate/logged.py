"""Poses out of a log at any times, for fits that shift its clock."""

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation, Slerp

from ..types.arrays import Scalars
from ..types.trajectory import Trajectory


class LogSampler:
    """Interpolates a log at times in any order; beyond its ends the log stands still."""

    def __init__(self, log: Trajectory) -> None:
        self.log = log
        self._rotations = Rotation.from_quat(log.quaternions, scalar_first=True)
        self._slerp = Slerp(log.times, self._rotations) if len(log.times) > 1 else None

    @property
    def interval(self) -> float:
        """Median time from one pose to the next [s]."""
        return float(np.median(np.diff(self.log.times))) if len(self.log.times) > 1 else 1.0

    def at(self, times: Scalars) -> tuple[Float[np.ndarray, "_ 3"], Rotation]:
        """Give positions [m] and attitudes at times [s]; row i belongs to time i."""
        inside = np.clip(times, self.log.times[0], self.log.times[-1])
        positions = [np.interp(inside, self.log.times, p) for p in self.log.positions.T]
        if self._slerp is None:
            return np.stack(positions, axis=1), self._rotations[np.zeros(len(times), dtype=int)]
        return np.stack(positions, axis=1), self._slerp(inside)
