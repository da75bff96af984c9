"""Numbers picked evenly from a stream whose length is not known beforehand."""

import numpy as np

from ..types.arrays import Scalars

_MOST = 1_000_000
"""Numbers kept: quantiles of so many are as good as those of all."""


class EvenSample:
    """Keeps all numbers while they are few, then every second, every fourth and so on."""

    def __init__(self, most: int = _MOST) -> None:
        """Begin with none; keep at most `most`."""
        self._most, self._stride, self._next, self._count = most, 1, 0, 0
        self._kept: list[Scalars] = []

    def add(self, values: np.ndarray) -> None:
        """Take note of further numbers."""
        some = values[self._next :: self._stride].astype(np.float64)
        self._next = (self._next - len(values)) % self._stride
        self._kept.append(some)
        self._count += len(some)
        while self._count > self._most:
            self._kept = [self.values()[::2]]
            self._next += self._stride * (self._count % 2)
            self._stride *= 2
            self._count = len(self._kept[0])

    def values(self) -> Scalars:
        """Give the numbers that were kept, in order."""
        return np.concatenate([np.zeros(0), *self._kept])
