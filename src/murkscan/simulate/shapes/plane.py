"""A flat rectangle: the shape whose every answer can be checked by hand."""

from dataclasses import dataclass
from typing import final

import numpy as np

from ...types.mesh import Mesh
from .base import AbstractShape, check_sizes


@final
@dataclass(frozen=True)
class Plane(AbstractShape):
    """A rectangle in z = 0 that faces the camera; the origin is its middle."""

    width: float = 1.0
    """Along x [m]."""
    height: float = 1.0
    """Along y [m]."""

    def __post_init__(self) -> None:
        """Refuse a rectangle without area."""
        check_sizes("A plane", width=self.width, height=self.height)

    def mesh(self) -> Mesh:
        """Make two triangles, without a back."""
        half = np.array([self.width, self.height]) / 2
        return rectangle_mesh(-half, half)


def rectangle_mesh(low: np.ndarray, high: np.ndarray) -> Mesh:
    """Make the rectangle in z = 0 between two corners x y [m]; it faces the camera."""
    (left, top), (right, bottom) = low, high
    vertices = np.array([[left, top, 0], [left, bottom, 0], [right, bottom, 0], [right, top, 0]])
    return Mesh(vertices.astype(float), np.array([[0, 1, 2], [0, 2, 3]]))
