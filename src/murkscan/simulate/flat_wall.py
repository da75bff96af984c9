"""A flat wall: the surface whose every answer can be checked by hand."""

from dataclasses import dataclass
from typing import final

import numpy as np

from ..types.arrays import Mask, Scalars, Vector
from .base import AbstractSurface


@final
@dataclass(frozen=True)
class FlatWall(AbstractSurface):
    """A rectangle, level or tilted."""

    distance: float = 0.5
    """Depth at x = y = 0 [m]."""
    slope: tuple[float, float] = (0.0, 0.0)
    """Growth of the depth along x and along y."""
    half_size: tuple[float, float] = (1.0, 1.0)
    """How far it reaches from x = y = 0 along x and along y [m]."""

    def depth(self, x: Scalars, y: Scalars) -> Scalars:
        """Give the wall's z at x and y [m]."""
        return self.distance + self.slope[0] * x + self.slope[1] * y

    def covers(self, x: Scalars, y: Scalars) -> Mask:
        """Tell whether x and y [m] lie on the rectangle."""
        return (np.abs(x) <= self.half_size[0]) & (np.abs(y) <= self.half_size[1])

    def box(self) -> tuple[Vector, Vector]:
        """Give the box that the rectangle spans [m]."""
        half = np.array(self.half_size)
        rise = np.abs(self.slope) @ half
        return (
            np.array([*-half, self.distance - rise]),
            np.array([*half, self.distance + rise]),
        )
