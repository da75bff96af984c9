"""Cubes of equal size through space, and which points share one."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import scipy

from ..errors import InputError
from ..types.arrays import Indices, Points, Vector

_MOST = 2**21
"""Cubes along an axis that a number of 63 bits can count."""
_ASKEW = (0.5, -0.4, 0.3)
"""How the grid is turned [rad]: a flat wall along an axis would otherwise lie in a layer of faces
for its whole length, and noise would sort its points into the cubes of both sides."""


@dataclass(frozen=True, eq=False)
class VoxelGrid:
    """Points in the cubes of a grid; empty cubes cost nothing."""

    points: Points
    """The points [m]."""
    size: float
    """Edge of a cube [m]."""
    origin: Vector = field(default_factory=lambda: np.zeros(3))
    """A corner of a cube [m]. Maps count in millions of metres, which are too many cubes."""

    def __post_init__(self) -> None:
        """Refuse cubes without size, and more of them than can be numbered."""
        if not 0 < self.size < np.inf:
            raise InputError(f"The edge of a voxel must be above 0, got {self.size:g} m.")
        reach = float(np.sqrt(3.0) * np.abs(self.points - self.origin).max(initial=0.0))
        if not reach < self.size * (_MOST // 2 - 1):
            raise InputError(
                f"Points lie as far as {reach:g} m apart, which is too far for voxels of "
                f"{self.size:g} m; take larger ones."
            )

    @property
    def keys(self) -> Indices:
        """Give the number of each point's cube: the same for equal places with an equal origin."""
        askew = scipy.spatial.transform.Rotation.from_rotvec(_ASKEW).as_matrix()
        cells = np.floor((self.points - self.origin) @ (askew / self.size)).astype(np.int64)
        cells += _MOST // 2
        return (cells[:, 0] * _MOST + cells[:, 1]) * _MOST + cells[:, 2]

    @cached_property
    def order(self) -> Indices:
        """Give the points cube by cube; within a cube they keep their order."""
        return np.argsort(self.keys, kind="stable")

    @cached_property
    def starts(self) -> Indices:
        """Give where in `order` each occupied cube begins."""
        keys = self.keys[self.order]
        return np.flatnonzero(np.concatenate([[True], keys[1:] != keys[:-1]])[: len(keys)])

    def sum(self, values: np.ndarray) -> np.ndarray:
        """Add up what the points of each occupied cube have, row by row."""
        if len(self.points) == 0:
            return values[:0]
        return np.add.reduceat(values[self.order], self.starts, axis=0)

    @property
    def counts(self) -> Indices:
        """Count the points of each occupied cube."""
        return np.diff(np.append(self.starts, len(self.points)))
