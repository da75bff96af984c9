"""A wall of sheet piles: ribs that repeat along it, and a bulge."""

import math
from dataclasses import dataclass
from typing import final

import numpy as np

from ...errors import InputError
from ...types.mesh import Mesh
from .base import AbstractShape, check_sizes

_ACROSS = 8
"""Cells of the grid along each of a rib's four parts."""
_STEP = 0.02
"""Edge of the grid's cells up the wall [m]: the bulge is 0.05 mm off between them, if it is 30 mm
high and a metre wide."""


@final
@dataclass(frozen=True)
class SheetPile(AbstractShape):
    """Ribs along y that repeat along x, as U-shaped piles make them, with a bulge to the camera.

    The outer faces lie in z = 0, the inner ones a depth behind; the origin is the middle::

        ┌────┐      ┌────┐      z = 0, towards the camera
             │      │
             └──────┘   ┈┈┈┈▶ x    z = depth; the flanks lean, each a quarter of a rib
    """

    width: float = 2.4
    """Along x [m]."""
    height: float = 6.0
    """Along y [m]."""
    rib: float = 0.6
    """Length along x after which ribs repeat [m]."""
    depth: float = 0.15
    """Of the ribs [m]."""
    bulge: float = 0.0
    """How far the middle stands out, towards the camera [m]."""
    bulge_width: float = 1.0
    """Standard deviation of the bulge, a Gaussian in x and y [m]."""

    def __post_init__(self) -> None:
        """Refuse a wall without size."""
        check_sizes(
            "A wall of sheet piles", width=self.width, height=self.height, rib=self.rib,
            depth=self.depth, bulge_width=self.bulge_width,
        )  # fmt: skip
        if not math.isfinite(self.bulge):
            raise InputError(f"The bulge must be a length, got {self.bulge:g} m.")

    def depth_at(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Give z of the surface [m]: four parts of a rib in turn out, in, back and out again."""
        part = 4 * np.mod(x / self.rib, 1.0)
        ribs = self.depth * np.interp(part, [0, 1, 2, 3, 4], [0.0, 0.0, 1.0, 1.0, 0.0])
        away = (x * x + y * y) / (2 * self.bulge_width**2)
        return ribs - self.bulge * np.exp(-away)

    def mesh(self) -> Mesh:
        """Make a grid whose lines follow the ribs' edges, without a back."""
        first = math.ceil(-self.width / 2 / self.rib * 4 * _ACROSS)
        inner = np.arange(first, -first + 1) * self.rib / (4 * _ACROSS)
        x = np.unique(np.concatenate([[-self.width / 2], inner, [self.width / 2]]).round(9))
        y = np.linspace(-self.height / 2, self.height / 2, math.ceil(self.height / _STEP) + 1)
        grid = np.stack(np.meshgrid(x, y), axis=-1)
        depth = self.depth_at(grid[..., 0], grid[..., 1])
        vertices = np.concatenate([grid, depth[..., None]], axis=-1).reshape(-1, 3)
        number = np.arange(len(vertices)).reshape(grid.shape[:2])
        left, right = number[:-1, :-1].ravel(), number[:-1, 1:].ravel()
        below_left, below_right = number[1:, :-1].ravel(), number[1:, 1:].ravel()
        faces = np.concatenate(
            [
                np.stack([left, below_left, below_right], axis=1),
                np.stack([left, below_right, right], axis=1),
            ]
        )
        return Mesh(vertices, faces)
