"""Half lines along which light travels."""

from dataclasses import dataclass

from .arrays import Directions, Points
from .short_repr import ShortRepr


@dataclass(frozen=True, eq=False, repr=False)
class Rays(ShortRepr):
    """Half lines, one a row."""

    origins: Points
    """Where each starts [m]."""
    directions: Directions
    """Where each points, of unit length."""
