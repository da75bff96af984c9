"""What a shape must know of itself, to be fitted."""

from typing import Protocol, TypeVar, runtime_checkable

import numpy as np
from jaxtyping import Float

from ..types.arrays import Directions, Points, Scalars, Vector

Slopes = Float[np.ndarray, "n p"]
"""Change of each point's distance with each parameter of a shape."""


_Own = TypeVar("_Own")


@runtime_checkable
class AnyShape(Protocol):
    """A surface with parameters that a fit may change."""

    def distance_to(self, points: Points) -> Scalars:
        """Signed distance of each point [m]."""

    def normals(self, points: Points) -> Directions:
        """Unit direction in which each distance grows."""

    def curvature(self, directions: Directions) -> Scalars:
        """How strongly the surface curves along each direction [1/m]."""

    def slopes(self, points: Points) -> Slopes:
        """Change of each distance with each parameter."""

    def moved(self: _Own, step: Float[np.ndarray, " p"]) -> _Own:
        """Change the parameters."""

    def shifted(self: _Own, offset: Vector) -> _Own:
        """Move it as a whole [m]."""
