"""Which parts of the surface the scan has, which it has not, and why not."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float, Int

from ..types.arrays import Scalars
from ..types.profile import Profile
from .coverage_cells import LONGEST, CellSums, add_up, choose_fullest, gather_cells, is_too_large
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
    layouts: Mapping[int, SwathLayout],
    *,
    reach: Reach,
    wanted: float,
    spacing: float,
) -> Coverage | None:
    """Map what the scan has and what it misses between its points; None without neighbours.

    Each point is joined to the next of its scan line. What lies between two that are more than
    `HOLE` wanted spacings apart is missing. What no profile lies around is not known to be a
    surface and is not counted. Where several lasers passed a place, that which shows most of it
    says what it is.

    Args:
        profiles: The points, in parts of whole frames in order; each is looked at once.
        layouts: How those of each laser lie on frames and scan lines, by its number.
        reach: How far the light went.
        wanted: Wanted spacing of the points [m].
        spacing: The larger of the usual spacings along and across [m].
    """
    hole, first = HOLE * wanted, next(iter(layouts.values()))
    cell = max(_CELL * max(wanted, spacing), first.reach / _MOST_CELLS)
    sheets = {laser: _Sheet(layout, reach, hole, cell) for laser, layout in layouts.items()}
    for profile in profiles:
        for laser, sheet in sheets.items():
            sheet.add(profile[profile.laser == laser])
    cells = gather_cells(choose_fullest([sheet.sums for sheet in sheets.values()]), edge=cell)
    if cells is None:
        return None
    return Coverage(first.directions, wanted, hole, cell, *cells, reach=reach)


@dataclass(eq=False)
class _Sheet:
    """What one laser's sheet has passed over so far."""

    layout: SwathLayout
    reach: Reach
    hole: float
    cell: float
    sums: list[CellSums] = field(default_factory=list)
    before: Swath | None = None
    pitch: float = 0.0
    num_lit: int = 0

    def add(self, profile: Profile) -> None:
        """Add the points of a part, whole frames that follow on those before."""
        for swath in self.layout.lay_out([profile], hole=self.hole):
            later = swath.after(self.num_lit)
            self.num_lit += len(later.lit)
            self.pitch = later.pitch() or self.pitch
            both = later.append_to(self.before)
            strips = cut_strips(both, hole=self.hole, pitch=self.pitch, reach=self.reach)
            is_point = later.cause == COVERED
            along, across = later.along[is_point], later.across[is_point]
            self.sums.append(CellSums.from_part(along, across, strips, self.cell))
            self.before = both.last_of_each_line()


class GrowingCoverage:
    """The map of a scan that is not at its end: parts are added in the order of their frames."""

    def __init__(self, *, wanted: float, cell: float, most: int) -> None:
        """Begin with nothing.

        Args:
            wanted: Wanted spacing of the points [m].
            cell: Edge of the map's cells [m].
            most: Cells above which they are made twice as large, to bound the memory.
        """
        self._wanted, self._most, self._cell = wanted, most, cell
        self._sheet: _Sheet | None = None
        self._earlier: list[CellSums] = []

    def go_on(self, sums: CellSums, cell: float) -> None:
        """Begin where an earlier run ended, before anything is added.

        Args:
            sums: Its `sums`.
            cell: The edge of its cells [m].
        """
        self._earlier, self._cell = [sums], cell

    @property
    def sums(self) -> tuple[CellSums, float] | None:
        """Give what was drawn up last, for `go_on`: the sums of the cells, and their edge [m]."""
        if self._sheet is None or not self._sheet.sums:
            return None
        return self._sheet.sums[0], self._sheet.cell

    def add(self, profiles: Iterable[Profile], layout: SwathLayout, reach: Reach) -> None:
        """Add points of one laser that come after all that were added.

        Args:
            profiles: The points, in parts of whole frames in order.
            layout: How they lie on frames and scan lines; its directions stay the same.
            reach: How far the light went, as far as that is known.
        """
        if self._sheet is None:
            hole = HOLE * self._wanted
            self._sheet = _Sheet(layout, reach, hole, self._cell, self._earlier)
        self._sheet.layout, self._sheet.reach = layout, reach
        for profile in profiles:
            self._sheet.add(profile)

    def as_map(self) -> Coverage | None:
        """Draw up the map of what was added; None without neighbours."""
        sheet = self._sheet
        if sheet is None or not sheet.sums:
            return None
        sums = add_up(sheet.sums)
        while is_too_large(sums, self._most):
            sums, sheet.cell = add_up([sums.coarser()]), 2 * sheet.cell
        sheet.sums = [sums]
        cells = gather_cells([sums], edge=sheet.cell, longest=LONGEST)
        if cells is None:
            return None
        directions = sheet.layout.directions
        return Coverage(directions, self._wanted, sheet.hole, sheet.cell, *cells, reach=sheet.reach)
