"""The axes in which a wall is drawn: along it, up it, and out of it."""

from dataclasses import dataclass

import numpy as np

from ..errors import InputError
from .arrays import Points, Vector
from .cylinder import Cylinder
from .plane import Plane
from .short_repr import ShortRepr

_UPRIGHT = 0.2
"""Sine of the angle between up and the wall's normal below which it is no wall but a floor."""


@dataclass(frozen=True, eq=False, repr=False)
class WallFrame(ShortRepr):
    """A plane or an upright cylinder, unrolled.

    Seen from where the camera was, along runs to the right, up upwards, and out towards the viewer.
    """

    origin: Vector
    """Where along, height and distance are 0, in the world [m]."""
    axes: np.ndarray
    """Unit directions along, up and out at the origin, one a row."""
    radius: float = 0.0
    """Of the cylinder [m], its axis behind the wall; negative: before it; 0: a plane."""

    @classmethod
    def of_plane(cls, plane: Plane, near: Vector, up: Vector) -> "WallFrame":
        """Lay the axes into a plane whose normal points to the viewer.

        Args:
            plane: The plane.
            near: A place beside the origin [m].
            up: A direction that is about upwards.

        Raises:
            InputError: The plane is level.
        """
        origin = near - plane.distance_to(near[None])[0] * plane.normal
        return cls(origin, _axes(plane.normal, up))

    @classmethod
    def of_cylinder(cls, cylinder: Cylinder, near: Vector, viewer: Vector) -> "WallFrame":
        """Unroll a cylinder: along runs round it, up along its axis.

        Args:
            cylinder: The cylinder; its axis' direction is up.
            near: A place beside the origin [m].
            viewer: A direction from the wall to the viewer.
        """
        away = near - cylinder.point
        away = away - (away @ cylinder.axis) * cylinder.axis
        outside = away / np.linalg.norm(away)
        origin = near - (np.linalg.norm(away) - cylinder.radius) * outside
        is_seen_outside = float(outside @ viewer) > 0
        out = outside if is_seen_outside else -outside
        radius = cylinder.radius if is_seen_outside else -cylinder.radius
        return cls(origin, _axes(out, cylinder.axis), radius)

    def locate(self, points: Points) -> Points:
        """Give along, height and distance out of the wall [m] of points of the world [m]."""
        local = (points - self.origin) @ self.axes.T
        if not self.radius:
            return local
        size, side = abs(self.radius), np.sign(self.radius)
        depth = side * local[:, 2] + size
        angle = np.arctan2(local[:, 0], depth)
        distance = side * (np.hypot(local[:, 0], depth) - size)
        return np.stack([size * angle, local[:, 1], distance], axis=1)

    def place(self, located: Points) -> Points:
        """Give points of the world [m] of along, height and distance [m]."""
        if not self.radius:
            return self.origin + located @ self.axes
        size, side = abs(self.radius), np.sign(self.radius)
        angle, reach = located[:, 0] / size, size + side * located[:, 2]
        out = side * (reach * np.cos(angle) - size)
        local = np.stack([reach * np.sin(angle), located[:, 1], out], axis=1)
        return self.origin + local @ self.axes

    def outwards(self, located: Points) -> Points:
        """Give the unit direction out of the wall at each place, in the world."""
        if not self.radius:
            return np.broadcast_to(self.axes[2], located.shape)
        angle, side = located[:, 0] / abs(self.radius), np.sign(self.radius)
        return side * np.sin(angle)[:, None] * self.axes[0] + np.cos(angle)[:, None] * self.axes[2]


def _axes(out: Vector, up: Vector) -> np.ndarray:
    upwards = up - (up @ out) * out
    length = float(np.linalg.norm(upwards))
    if length < _UPRIGHT * float(np.linalg.norm(up)):
        raise InputError(
            "The surface lies level rather than upright; say which direction is up with --up X,Y,Z."
        )
    upwards = upwards / length
    return np.stack([np.cross(upwards, out), upwards, out])
