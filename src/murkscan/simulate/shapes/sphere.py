"""A ball."""

from dataclasses import dataclass
from typing import final

import numpy as np

from ...types.mesh import Mesh
from .base import AbstractShape, check_sizes

_HALVINGS = 7
"""Times that the edges of an icosahedron are halved: 327 680 triangles."""


@final
@dataclass(frozen=True)
class Sphere(AbstractShape):
    """A ball; the origin is its centre.

    The triangles' corners lie on the ball, and their middles at most 1.8e-5 of the radius inside
    it: 1.8 µm at 0.1 m.
    """

    radius: float = 0.1
    """Radius [m]."""

    def __post_init__(self) -> None:
        """Refuse a ball without size."""
        check_sizes("A sphere", radius=self.radius)

    def mesh(self) -> Mesh:
        """Make a closed surface of triangles of nearly one size."""
        from trimesh import creation

        ball = creation.icosphere(subdivisions=_HALVINGS, radius=self.radius)
        return Mesh(np.array(ball.vertices, float), np.array(ball.faces, np.int64))
