"""A surface of triangles."""

from dataclasses import dataclass

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
