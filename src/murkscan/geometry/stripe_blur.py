"""How a blurred stripe misses a surface that curves along it.

A lens's blur mixes, into each scan line, light of its neighbours. On a straight stripe they
balance; on one that bends they pull the centre to the hollow side, and where it slopes in the
picture they pull it to the brighter neighbour. For Lambert's law, blur of variance s² [m²] along
the stripe, and a surface of curvature k whose normal leans by an angle f from the line of sight,
along the stripe, the centre's distance from the surface is

    s² k (tan² f - 2 tan f tan a - 1) / 2,

towards the camera where it is positive. Here a is the angle of the line of sight itself from the
plane across the stripe, and f counts towards the side to which a does: in the middle of the picture
the distance is 0 at 45 degrees, three times its size in front at 63. At its sides the stripe does
not slope where the surface faces the camera, but where it is parallel to the picture, and the
distances are even about that place.

It follows from the inverse depth w along u = x / z, which the blur changes by s_u² (w'' / 2 +
w' I' / I). With w'' = - k cos³ a / cos³ f, w' = - cos² a (tan f - tan a) / z, the light's
I' / I = - k z tan f cos a / cos f and s = s_u z cos a, the formula is that change along the line of
sight, times cos f.
"""

from dataclasses import dataclass

import numpy as np

from ..types.arrays import Directions, Mask, Points, Scalars
from .shape import AnyShape

_LEAST_FACING = 0.5
"""Cosine of the angle between normal and line of sight, or the light, below which the stripe on a
curved surface is not to be trusted: 60 degrees. Where the light grazes, the stripe widens, and its
far side is darker than its near one."""


@dataclass(frozen=True, eq=False)
class Sight:
    """From where points were seen."""

    rays: Directions
    """Unit direction from the camera to each point."""
    along: Directions
    """Unit direction in which the stripe runs in the picture, at each point."""
    light: Directions | None = None
    """Unit direction of the light at each point, as far as it lies across the stripe; None where
    nobody knows."""

    def __getitem__(self, which: Mask) -> "Sight":
        """Pick some of the points."""
        light = None if self.light is None else self.light[which]
        return Sight(self.rays[which], self.along[which], light)


def blur_slopes(shape: AnyShape, points: Points, sight: Sight) -> Scalars:
    """Give the change of each point's distance from a shape with the variance of the blur [1/m]."""
    bend = shape.curvature(sight.along) * _towards_camera(shape, points, sight)
    lean = _lean(shape, points, sight)
    return bend * (lean**2 - 2 * lean * _slant(sight) - 1) / 2


def is_readable(shape: AnyShape, points: Points, sight: Sight) -> Mask:
    """Tell which points do not lie where a curved surface turns from the camera or the light."""
    bent = np.abs(shape.curvature(sight.along)) > 0
    return ~bent | is_facing(shape.normals(points), sight)


def is_facing(normals: Directions, sight: Sight) -> Mask:
    """Tell which points do not turn from the camera or the light by 60 degrees or more."""
    ways = [way for way in (sight.rays, sight.light) if way is not None]
    facing = [np.abs(np.einsum("ij,ij->i", normals, way)) > _LEAST_FACING for way in ways]
    return np.asarray(np.all(facing, axis=0))


def _lean(shape: AnyShape, points: Points, sight: Sight) -> Scalars:
    """Give tan of the angle from the line of sight back to the camera to the normal.

    It counts along the stripe; of a hollow shape the normal is the one that faces the camera.
    """
    normals = shape.normals(points)
    facing = _facing(shape, points, sight)
    sideways = sight.along - np.einsum("ij,ij->i", sight.along, sight.rays)[:, None] * sight.rays
    sideways /= np.linalg.norm(sideways, axis=1, keepdims=True)
    slope = np.einsum("ij,ij->i", normals, sideways)
    return -slope / np.where(np.abs(facing) < 1e-9, 1e-9, facing)


def _slant(sight: Sight) -> Scalars:
    """Give tan of the angle between each line of sight and the plane across the stripe."""
    along = np.einsum("ij,ij->i", sight.along, sight.rays)
    return along / np.sqrt(1 - along**2)


def _towards_camera(shape: AnyShape, points: Points, sight: Sight) -> Scalars:
    """Give 1 where the shape's distance grows towards the camera, -1 inside a hollow one."""
    return -np.sign(_facing(shape, points, sight))


def _facing(shape: AnyShape, points: Points, sight: Sight) -> Scalars:
    """Give the cosine between line of sight and the direction in which distance grows."""
    return np.einsum("ij,ij->i", shape.normals(points), sight.rays)
