"""Which part of a scan is measured."""

from dataclasses import dataclass

import numpy as np

from ..errors import InputError
from ..types.arrays import Mask, Points, Vector


@dataclass(frozen=True)
class Ball:
    """All points within a distance of a place."""

    centre: tuple[float, float, float]
    """The place, in the world [m]."""
    radius: float
    """The distance [m]."""

    def __post_init__(self) -> None:
        """Refuse a ball without size."""
        if not self.radius > 0:
            raise InputError(f"The radius of a selection must be above 0, got {self.radius:g} m.")

    def contains(self, points: Points) -> Mask:
        """Tell which points lie inside."""
        return np.linalg.norm(points - np.array(self.centre), axis=1) <= self.radius

    @property
    def bounds(self) -> tuple[Vector, Vector]:
        """Its lowest and highest coordinates [m]."""
        return np.array(self.centre) - self.radius, np.array(self.centre) + self.radius


@dataclass(frozen=True)
class Box:
    """All points between two corners, along the world's axes."""

    low: tuple[float, float, float]
    """The corner with the smallest coordinates [m]."""
    high: tuple[float, float, float]
    """The corner with the largest ones [m]."""

    def __post_init__(self) -> None:
        """Refuse a box without size."""
        if not all(low < high for low, high in zip(self.low, self.high, strict=True)):
            raise InputError(
                f"The first corner of a box must be below the second in x, y and z; got {self.low} "
                f"and {self.high} m."
            )

    def contains(self, points: Points) -> Mask:
        """Tell which points lie inside."""
        return np.all((points >= self.low) & (points <= self.high), axis=1)

    @property
    def bounds(self) -> tuple[Vector, Vector]:
        """Its lowest and highest coordinates [m]."""
        return np.array(self.low), np.array(self.high)


Selection = Ball | Box
"""A part of space."""
