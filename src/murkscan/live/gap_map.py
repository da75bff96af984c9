"""The map of what a dive has and has not, as it is shown while it grows."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import UInt8

from ..types.arrays import Vector

NOTHING = 255
"""Where no profile says that there is a surface."""


@dataclass(frozen=True, eq=False)
class GapMap:
    """The scanned surface in square cells, as seen from the scanner: rows across, columns along."""

    state: UInt8[np.ndarray, "h w"]
    """What most of each cell is: 0 covered, k missing by the k-th cause, 255 nothing known."""
    causes: tuple[str, ...]
    """Why surface can be missing; the first has the number 1."""
    cell: float
    """Edge of a cell [m]."""
    corner: tuple[float, float]
    """The first cell's first corner, along the motion and across it, in the world frame [m]."""
    along: Vector
    """Direction of the motion in the world frame, of unit length."""
    across: Vector
    """Direction across it, along the stripe."""
    covered: float
    """Area that is covered [m²]."""
    missing: float
    """Area that is not [m²]."""

    @property
    def share(self) -> float | None:
        """Compute the share of the surface that is covered; None where there is no surface."""
        total = self.covered + self.missing
        return self.covered / total if total > 0 else None
