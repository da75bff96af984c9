"""Stairs: level treads and true vertical risers."""

import math
from dataclasses import dataclass
from typing import final

import numpy as np

from ...errors import InputError
from ...types.mesh import Mesh
from .base import AbstractShape, check_sizes
from .solids import enclose_blocks, refine_line

_CELLS, _CELLS_ACROSS = 16, 80
"""Cells of the grid along one tread, and across the stairs."""
_MOST_BLOCKS = 10_000_000
"""Blocks of the grid, of which each takes about a hundred bytes."""


@final
@dataclass(frozen=True)
class Stairs(AbstractShape):
    """Level treads one behind the other along y, joined by risers at a right angle, as a solid.

    Tread i lies in z = - heights[i], from y = i treads to y = i + 1 treads. The origin is the
    middle of the first tread's outer edge, at height 0. The solid reaches one tread's length
    behind that::

        camera  ┊                 ┌─────
                ┊          ┌──────┘        heights 0, 0.015 and 0.03
                o──────────┘ ┈┈┈┈▶ y
                │
              z ▼
    """

    width: float = 0.4
    """Along x [m]."""
    tread: float = 0.08
    """Length of one tread along y [m]."""
    heights: tuple[float, ...] = (0.0, 0.005, 0.015, 0.03, 0.05)
    """Height of each tread towards the camera [m]."""

    def __post_init__(self) -> None:
        """Refuse stairs without a tread, and treads behind height 0."""
        check_sizes("A flight of stairs", width=self.width, tread=self.tread)
        if not self.heights or not all(math.isfinite(h) and h >= 0 for h in self.heights):
            raise InputError(
                f"Stairs need one height or more, each 0 m or above, got heights = "
                f"{list(self.heights)} m."
            )
        blocks = _CELLS_ACROSS * len(self.heights) * _CELLS * self._num_layers
        if blocks > _MOST_BLOCKS:
            raise InputError(
                f"Stairs of {len(self.heights)} treads of {self.tread:g} m up to "
                f"{max(self.heights):g} m are made of {blocks:.2g} blocks, which are too many; "
                "take fewer treads, or longer ones."
            )

    @property
    def _depths(self) -> np.ndarray:
        """Give z of the back and of each level [m], growing."""
        return np.unique([self.tread, *(0.0 - np.array(self.heights))])

    @property
    def _num_layers(self) -> float:
        """Count the layers of the grid that `refine_line` will make of the depths."""
        return float(np.ceil(np.diff(self._depths) / (self.tread / _CELLS)).sum())

    def mesh(self) -> Mesh:
        """Make a closed surface: treads, risers, both sides and the back."""
        level, depths = 0.0 - np.array(self.heights), self._depths
        z = refine_line(depths[:, None], self.tread / _CELLS)[:, 0]
        y = np.arange(len(level) * _CELLS + 1) * (self.tread / _CELLS)
        x = np.linspace(-self.width / 2, self.width / 2, _CELLS_ACROSS + 1)
        layer = (z[:-1] + z[1:]) / 2
        filled = layer > np.repeat(level, _CELLS)[:, None]
        return enclose_blocks(x, y, z, np.broadcast_to(filled, (_CELLS_ACROSS, *filled.shape)))
