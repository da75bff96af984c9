"""A wall as a raster of distances, and where it departs from its reference."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.ndimage import find_objects, generic_filter, label

from ..errors import InputError
from ..types.arrays import Points, Scalars

Raster = Float[np.ndarray, "h w"]

_MOST_CELLS = 50_000_000
_GAUSSIAN = 1.4826
"""Standard deviation of Gaussian noise as a multiple of its median absolute value."""
_SURE = 4.0
"""Standard deviations of a cell below which a departure is chance."""
_FEW_AROUND = 10
"""Cells around an anomaly that are shown with it, at least."""
_FEWEST = 4
"""Cells of an anomaly, at least."""


@dataclass(frozen=True, eq=False)
class WallMap:
    """Mean distance from the reference, cell by cell; row 0 is the lowest."""

    values: Raster
    """Distance out of the wall [m]; NaN where nothing was seen."""
    low: tuple[float, float]
    """Along and height of the outer corner of the first cell [m]."""
    cell: float
    """Edge of a cell [m]."""

    @property
    def noise(self) -> float:
        """Standard deviation of a cell, from how neighbours differ [m]."""
        steps = np.diff(self.values, axis=0)
        steps = steps[np.isfinite(steps)]
        if not len(steps):
            return 0.0
        return _GAUSSIAN * float(np.median(np.abs(steps - np.median(steps)))) / 2**0.5

    def middle_of(self, row: float, column: float) -> tuple[float, float]:
        """Give along and height of a cell's middle [m]."""
        return (
            self.low[0] + (column + 0.5) * self.cell,
            self.low[1] + (row + 0.5) * self.cell,
        )

    def around(self, anomaly: "Anomaly") -> "WallMap":
        """Give the part around an anomaly: half its size to each side, ten cells at least."""
        room = max(_FEW_AROUND * self.cell, max(anomaly.width, anomaly.rise) / 2)
        first, last = [], []
        sides = ((anomaly.height, anomaly.rise, 1), (anomaly.along, anomaly.width, 0))
        for (middle, size, axis), count in zip(sides, self.values.shape, strict=True):
            # Where it is farthest off may be anywhere in it.
            low = (middle - size - room - self.low[axis]) / self.cell
            high = (middle + size + room - self.low[axis]) / self.cell
            first.append(int(np.clip(low, 0, count - 1)))
            last.append(int(np.clip(np.ceil(high), first[-1] + 1, count)))
        corner = (self.low[0] + first[1] * self.cell, self.low[1] + first[0] * self.cell)
        return WallMap(self.values[first[0] : last[0], first[1] : last[1]], corner, self.cell)

    def without_profile(self) -> "WallMap":
        """Take off what repeats along the height: each column's median.

        That is the wall's own profile, such as the ribs of sheet piles.
        """
        seen = np.isfinite(self.values).any(axis=0)
        profile = np.full(self.values.shape[1], np.nan)
        profile[seen] = np.nanmedian(self.values[:, seen], axis=0)
        return replace(self, values=self.values - profile)


def map_wall(located: Points, cell: float) -> WallMap:
    """Gather points into cells.

    Args:
        located: Along, height and distance of points [m], at least one.
        cell: Edge of a cell [m].

    Raises:
        InputError: The map would have too many cells.
    """
    low = np.floor(located[:, :2].min(axis=0) / cell) * cell
    width, height = (np.floor((located[:, :2].max(axis=0) - low) / cell) + 1).astype(int).tolist()
    if width * height > _MOST_CELLS:
        raise InputError(
            f"A map of {width:,} × {height:,} cells is too large; give a larger --cell-mm."
        )
    column, row = ((located[:, :2] - low) / cell).astype(int).T
    number = row * width + column
    counts = np.bincount(number, minlength=width * height)
    sums = np.bincount(number, located[:, 2], width * height)
    values = np.full(width * height, np.nan)
    np.divide(sums, counts, out=values, where=counts > 0)
    return WallMap(values.reshape(height, width), (float(low[0]), float(low[1])), cell)


@dataclass(frozen=True)
class Anomaly:
    """A part of a wall that stands out of its reference, or behind it."""

    along: float
    """Where it is farthest off [m]."""
    height: float
    distance: float
    """How far it is off there: the mean of the cells around [m]; above 0 is out of the wall."""
    cells: int
    """Cells there of which that is the mean."""
    width: float
    """Its extent along the wall [m]."""
    rise: float
    """Its extent in height [m]."""
    area: float
    """Area of its cells [m²]."""


def find_anomalies(wall: WallMap, *, least: float) -> list[Anomaly]:
    """Find the connected parts whose cells are off by more than a distance, the largest first.

    Args:
        wall: The map.
        least: The distance [m]; chance, four standard deviations of a cell, is more in any case.
    """
    limit = max(least, _SURE * wall.noise)
    found = []
    for sign in (1.0, -1.0):
        parts, _ = label(np.nan_to_num(sign * wall.values) > limit, structure=np.ones((3, 3)))
        for number, box in enumerate(find_objects(parts), 1):
            mine = parts[box] == number
            if mine.sum() >= _FEWEST:
                found.append(_describe(wall, (box[0], box[1]), mine, sign))
    return sorted(found, key=lambda one: -one.area * abs(one.distance))


def _describe(wall: WallMap, box: tuple[slice, slice], mine: np.ndarray, sign: float) -> Anomaly:
    values = np.where(mine, wall.values[box], np.nan)
    around = _smooth(values)
    row, column = np.unravel_index(int(np.nanargmax(sign * around)), values.shape)
    near = values[max(row - 1, 0) : row + 2, max(column - 1, 0) : column + 2]
    rows, columns = box
    along, height = wall.middle_of(rows.start + float(row), columns.start + float(column))
    return Anomaly(
        along,
        height,
        float(around[row, column]),
        int(np.isfinite(near).sum()),
        (columns.stop - columns.start) * wall.cell,
        (rows.stop - rows.start) * wall.cell,
        float(mine.sum()) * wall.cell**2,
    )


def _smooth(values: Raster) -> Raster:
    """Give the mean of the cells around each one that there is."""
    mean = generic_filter(values, _mean, size=3, mode="constant", cval=np.nan)
    return np.where(np.isfinite(values), mean, np.nan)


def _mean(around: Scalars) -> float:
    known = around[np.isfinite(around)]
    return float(known.mean()) if len(known) else float("nan")
