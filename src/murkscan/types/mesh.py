"""A surface of triangles."""

from dataclasses import dataclass

import numpy as np

from .arrays import Colours, FaceMask, Faces, Indices, Points
from .short_repr import ShortRepr


@dataclass(frozen=True, eq=False, repr=False)
class Mesh(ShortRepr):
    """Triangles between vertices, in the world frame."""

    vertices: Points
    """Corners of the triangles [m]."""
    faces: Faces
    """Three vertex numbers a triangle, counter-clockwise seen from outside."""
    filled: FaceMask | None = None
    """Which triangles close a hole, so that nothing was measured there; None: no such triangle."""
    colours: Colours | None = None
    """Red, green and blue of each vertex, as a screen shows them; None: it has no colours."""
    points: Indices | None = None
    """Row of the cloud's point that each vertex is or stands for; None: it was made of none."""

    def compact(self) -> "Mesh":
        """Leave out the vertices that no triangle has."""
        used = used_vertices(self.faces)
        number = np.zeros(len(self.vertices), np.int64)
        number[used] = np.arange(len(used))
        rest = (None if own is None else own[used] for own in (self.colours, self.points))
        return Mesh(self.vertices[used], number[self.faces], self.filled, *rest)


def used_vertices(faces: Faces) -> Indices:
    """Give the numbers of the vertices that triangles have, in order."""
    return np.flatnonzero(np.bincount(faces.ravel()))
