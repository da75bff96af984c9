"""A surface of triangles."""

from dataclasses import dataclass

from .arrays import Faces, Points


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles between vertices, in the world frame."""

    vertices: Points
    """Corners of the triangles [m]."""
    faces: Faces
    """Three vertex numbers a triangle, counter-clockwise seen from outside."""
