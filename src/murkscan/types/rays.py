"""Half lines along which light travels."""

from dataclasses import dataclass

from .arrays import Directions, Points


@dataclass(frozen=True, eq=False)
class Rays:
    """Half lines, one a row."""

    origins: Points
    """Where each starts [m]."""
    directions: Directions
    """Where each points, of unit length."""
