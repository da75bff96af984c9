"""Colour by depth: how far from the camera."""

from dataclasses import dataclass
from typing import final

import numpy as np

from ..types.arrays import Colours
from ..types.mesh import Mesh
from .paint import AbstractPaint, Signal, map_colours


@final
@dataclass(frozen=True)
class ByDepth(AbstractPaint):
    """Viridis, bright where it is near: equal steps of depth look equal."""

    forward: tuple[float, float, float] = (0.0, 0.0, 1.0)
    """The direction in which depth is counted, in the world frame."""

    def paint(self, mesh: Mesh, signal: Signal) -> Colours:
        """See `AbstractPaint.paint`; the signal is not asked."""
        return map_colours(mesh.vertices @ np.array(self.forward), "viridis_r")
