"""Which parts of the surface the scan has, which it has not, and why not."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from ..types.arrays import Scalars
from ..types.profile import Profile
from .coverage_cells import CellSums, gather_cells
from .directions import SurfaceDirections
from .reach import Reach
from .strips import cut_strips
from .swath import CAUSES, COVERED, Swath
from .swath_layout import SwathLayout

HOLE = 2.0
"""Distance of neighbours, in wanted spacings, above which there is a hole between them: room for
another point as wanted."""
_CELL = 3.0
"""Edge of a cell of the map, in spacings of the points."""
_MOST_CELLS = 400
"""Cells of the map along its longer side, about."""


@dataclass(frozen=True, eq=False)
class Coverage:
    """A map of the scanned surface, as seen from the scanner: rows across, columns along."""

    directions: SurfaceDirections
    wanted: float
    """Spacing of the points by which gaps are judged [m]."""
    hole: float
    """Distance of neighbours above which there is a hole between them [m]."""
    cell: float
    """Edge of the map's cells [m]."""
    corner: tuple[float, float]
    """The first cell's first corner, along the motion and across it, in the world frame [m]."""
    points: Int[np.ndarray, "h w"]
    """Points in each cell."""
    areas: Float[np.ndarray, "k h w"]
    """Area of each cell that is covered, then that which is missing by each cause [m²]."""
    total: Scalars
    """The same of the whole scan [m²]."""
    reach: Reach
    """How far the light went: by it what is too far is told from what is too dark."""

    def state(self) -> Int[np.ndarray, "h w"]:
        """Give what most of each cell is: 0 covered, 1 and on the cause, -1 where nothing is."""
        most = self.areas.argmax(axis=0)
        return np.where(self.areas.sum(axis=0) > 0, most, np.where(self.points > 0, 0, -1))

    @property
    def mapped(self) -> float:
        """Area of the surface, covered or not [m²]."""
        return float(self.total.sum())

    @property
    def covered(self) -> float:
        """Area that is covered [m²]."""
        return float(self.total[0])

    @property
    def missing(self) -> dict[str, float]:
        """Area that is missing by each cause [m²]."""
        return dict(zip(CAUSES, self.total[1:].tolist(), strict=True))


def map_coverage(
    profiles: Iterable[Profile],
    layout: SwathLayout,
    *,
    reach: Reach,
    wanted: float,
    spacing: float,
) -> Coverage | None:
    """Map what the scan has and what it misses between its points; None without neighbours.

    Each point is joined to the next of its scan line. What lies between two that are more than
    `HOLE` wanted spacings apart is missing. What no profile lies around is not known to be a
    surface and is not counted.

    Args:
        profiles: The points, in parts of whole frames in order; each is looked at once.
        layout: How they lie on frames and scan lines.
        reach: How far the light went.
        wanted: Wanted spacing of the points [m].
        spacing: The larger of the usual spacings along and across [m].
    """
    hole = HOLE * wanted
    cell = max(_CELL * max(wanted, spacing), layout.reach / _MOST_CELLS)
    sums: list[CellSums] = []
    before: Swath | None = None
    pitch, num_lit = 0.0, 0
    for swath in layout.lay_out(profiles, hole=hole):
        later = swath.after(num_lit)
        num_lit += len(later.lit)
        pitch = later.pitch() or pitch
        both = later.append_to(before)
        strips = cut_strips(both, hole=hole, pitch=pitch, reach=reach)
        is_point = later.cause == COVERED
        sums.append(CellSums.from_part(later.along[is_point], later.across[is_point], strips, cell))
        before = both.last_of_each_line()
    cells = gather_cells(sums, edge=cell)
    if cells is None:
        return None
    return Coverage(layout.directions, wanted, hole, cell, *cells, reach=reach)
