"""A place where a surface departs from what it should be."""

from dataclasses import dataclass

from .arrays import Vector
from .quantity import Quantity
from .short_repr import ShortRepr


@dataclass(frozen=True, eq=False, repr=False)
class Dent(ShortRepr):
    """A dent, or a bump: its depth is then negative."""

    place: Vector
    """Its middle on the surface, in the world [m]."""
    sigma_place: Vector
    """Standard deviation of the middle along x, y and z of the world, of both parts [m]."""
    depth: Quantity
    """How far its deepest place lies behind the reference [m]."""
    diameter: Quantity
    """Diameter of a circle of its area, where it is deeper than a tenth of its depth [m]."""
    volume: Quantity
    """What is missing, or negative, what stands out [m³]."""
    num_points: int
    """Points of the scan in it."""
