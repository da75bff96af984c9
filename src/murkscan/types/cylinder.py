"""An endless pipe's surface."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from .arrays import Points, Scalars, Vector
from .plane import span_plane
from .short_repr import ShortRepr


@dataclass(frozen=True, eq=False, repr=False)
class Cylinder(ShortRepr):
    """All points at one distance from a straight line."""

    point: Vector
    """A point of the axis [m]."""
    axis: Vector
    """Unit direction of the axis."""
    radius: float
    """Its radius [m]."""

    def distance_to(self, points: Points) -> Scalars:
        """Signed distance of each point [m], positive outside."""
        return np.linalg.norm(self._across(points), axis=1) - self.radius

    def normals(self, points: Points) -> Points:
        """Give the unit direction away from the axis at each point."""
        across = self._across(points)
        return across / np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-300)

    def curvature(self, directions: Points) -> Scalars:
        """Give how strongly the surface curves along each direction, unit length [1/m]."""
        return (1 - (directions @ self.axis) ** 2) / self.radius

    def slopes(self, points: Points) -> Float[np.ndarray, "n p"]:
        """Give the change of each distance with two shifts and two tilts of the axis, and radius.

        Both run along the directions of `span_plane(axis)`; tilts are about `point` [rad].
        """
        shifts = -self.normals(points) @ span_plane(self.axis).T
        along = (points - self.point) @ self.axis
        ones = np.ones((len(points), 1))
        return np.concatenate([shifts, shifts * along[:, None], -ones], axis=1)

    def moved(self, step: Float[np.ndarray, " p"]) -> "Cylinder":
        """Shift [m] and tilt [rad] the axis, and change the radius [m]; as in `slopes`."""
        sides = span_plane(self.axis)
        axis = self.axis + step[2:4] @ sides
        return Cylinder(
            self.point + step[:2] @ sides, axis / np.linalg.norm(axis), float(self.radius + step[4])
        )

    def shifted(self, offset: Vector) -> "Cylinder":
        """Move it as a whole [m]."""
        return Cylinder(self.point + offset, self.axis, self.radius)

    def _across(self, points: Points) -> Points:
        """Give the way from the axis to each point, at right angles to it [m]."""
        away = points - self.point
        return away - (away @ self.axis)[:, None] * self.axis
