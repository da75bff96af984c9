"""A pipe or a pile."""

import math
from dataclasses import dataclass
from typing import final

import numpy as np

from ...types.mesh import Mesh
from .base import AbstractShape, check_sizes
from .solids import close_tube, refine_line

_SECTIONS = 720
"""Facets around."""
_CELLS, _MOST_CELLS = 20, 200
"""Cells along one radius of the length, and at most along all of it."""


@final
@dataclass(frozen=True)
class Cylinder(AbstractShape):
    """A closed cylinder along y, the way a rig with its laser along y travels.

    The origin is the middle of its axis. The corners of the facets lie on the cylinder, their
    middles 0.95e-5 of the radius inside it: 0.95 µm at 0.1 m.
    """

    radius: float = 0.1
    """Radius [m]."""
    length: float = 0.5
    """Along y [m]."""

    def __post_init__(self) -> None:
        """Refuse a cylinder without size."""
        check_sizes("A cylinder", radius=self.radius, length=self.length)

    def mesh(self) -> Mesh:
        """Make a closed surface."""
        angles = np.linspace(0, math.tau, _SECTIONS, endpoint=False)
        ends = np.array([[-self.length / 2], [self.length / 2]])
        y = refine_line(ends, max(self.radius / _CELLS, self.length / _MOST_CELLS))
        rings = np.empty((len(y), _SECTIONS, 3))
        rings[..., 0], rings[..., 2] = np.cos(angles) * self.radius, -np.sin(angles) * self.radius
        rings[..., 1] = y
        return close_tube(rings)
