"""A ball's surface."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from .arrays import Points, Scalars, Vector
from .short_repr import ShortRepr


@dataclass(frozen=True, eq=False, repr=False)
class Sphere(ShortRepr):
    """All points at one distance from a centre."""

    centre: Vector
    """Its centre [m]."""
    radius: float
    """Its radius [m]."""

    def distance_to(self, points: Points) -> Scalars:
        """Signed distance of each point [m], positive outside."""
        return np.linalg.norm(points - self.centre, axis=1) - self.radius

    def normals(self, points: Points) -> Points:
        """Give the unit direction outwards at each point."""
        away = points - self.centre
        return away / np.maximum(np.linalg.norm(away, axis=1, keepdims=True), 1e-300)

    def curvature(self, directions: Points) -> Scalars:
        """Give how strongly the surface curves along each direction [1/m]."""
        return np.full(len(directions), 1 / self.radius)

    def slopes(self, points: Points) -> Float[np.ndarray, "n p"]:
        """Give the change of each distance with the centre's x, y and z, and the radius."""
        return np.concatenate([-self.normals(points), np.full((len(points), 1), -1.0)], axis=1)

    def moved(self, step: Float[np.ndarray, " p"]) -> "Sphere":
        """Change the centre's x, y and z, and the radius [m]."""
        return Sphere(self.centre + step[:3], float(self.radius + step[3]))

    def shifted(self, offset: Vector) -> "Sphere":
        """Move it as a whole [m]."""
        return Sphere(self.centre + offset, self.radius)
