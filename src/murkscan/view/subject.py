"""A surface made ready to be looked at from several sides."""

from dataclasses import dataclass

import numpy as np

from ..errors import InputError, NotEnoughData
from ..types.arrays import Directions, Points
from ..types.cloud import PointCloud
from ..types.mesh import Mesh
from .splats import look_at_points
from .surface import look_at_mesh, vertex_normals
from .views import View
from .window import Relief, Window


@dataclass(frozen=True, eq=False)
class Subject:
    """A surface, and what of it is the same from every side."""

    surface: Mesh | PointCloud
    """What is looked at."""
    points: Points
    """Its vertices or points, in the world frame [m]."""
    normals: Directions
    """Their unit normals, in the world frame."""

    @classmethod
    def of(cls, surface: Mesh | PointCloud) -> "Subject":
        """Make a surface ready.

        Raises:
            NotEnoughData: There is nothing to draw.
            InputError: A point is not finite.
        """
        points = surface.vertices if isinstance(surface, Mesh) else surface.points
        _require_something(surface, points)
        if isinstance(surface, Mesh):
            return cls(surface, points, vertex_normals(points, surface.faces))
        return cls(surface, points, surface.normals.astype(float))

    def look(self, view: View, samples: Points, window: Window) -> Relief:
        """Find what is seen of it in each sample of a picture.

        Args:
            view: From where.
            samples: Its points in samples of the window, with their depth.
            window: The picture.
        """
        normals = self.normals @ view.view_from_world.T
        if isinstance(self.surface, Mesh):
            return look_at_mesh(self.surface, samples, normals, window)
        return look_at_points(samples, normals, window)


def _require_something(surface: Mesh | PointCloud, points: Points) -> None:
    if len(points) == 0 or (isinstance(surface, Mesh) and len(surface.faces) == 0):
        raise NotEnoughData("There is nothing to draw: the surface has no points or no triangles.")
    broken = len(points) - int(np.isfinite(points).all(axis=1).sum())
    if broken:
        raise InputError(
            f"{broken} of {len(points)} points to draw are not finite; leave them out."
        )
