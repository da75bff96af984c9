"""A scan as a map: mean heights in square cells of a plane that faces the camera."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.ndimage import gaussian_filter

from ..errors import InputError, NotEnoughData
from ..types.arrays import Directions, Indices, Matrix3, Points, Scalars, Vector
from ..types.plane import span_plane

_MOST_CELLS = 20_000_000

Map = Float[np.ndarray, "h w"]


@dataclass(frozen=True, eq=False)
class MapFrame:
    """Where a map lies in the world, and how large its cells are."""

    origin: Vector
    """The place of its first cell's outer corner, at height 0 [m]."""
    map_from_world: Matrix3
    """Rows point along the map's columns, along its rows, and up, towards the camera."""
    cell: float
    """Side of a cell [m]."""
    shape: tuple[int, int]
    """Rows and columns."""

    @classmethod
    def over(cls, points: Points, normals: Directions, cell: float) -> "MapFrame":
        """Lay a map under points.

        Args:
            points: The points [m], in the world.
            normals: Their normals, turned to the camera; zero where there is none.
            cell: Side of a cell [m].

        Raises:
            NotEnoughData: There are no points, or none has a normal.
            InputError: The cells are so small that there are too many.
        """
        up = normals.sum(axis=0, dtype=float)
        length = float(np.linalg.norm(up))
        if len(points) == 0 or length == 0:
            raise NotEnoughData(
                f"None of the {len(points)} points has a normal, as from a single profile; scan "
                "two profiles or more."
            )
        axes = np.concatenate([span_plane(up / length), (up / length)[None]])
        along = points @ axes.T
        low = along.min(axis=0)
        with np.errstate(over="ignore", divide="ignore"):
            columns, rows = (np.ptp(along[:, :2], axis=0) / cell).tolist()
        # Beyond this the numbers have no whole parts that fit.
        if not (columns + 1) * (rows + 1) <= _MOST_CELLS:
            raise InputError(
                f"A map of {columns:.3g} × {rows:.3g} cells of {cell * 1e3:g} mm is too large; "
                "measure a part of the scan, or look for larger things."
            )
        return cls(
            np.array([low[0], low[1], 0.0]) @ axes, axes, cell, (int(rows) + 1, int(columns) + 1)
        )

    def locate(self, points: Points) -> Points:
        """Give points of the world as places along columns and rows, and heights [m]."""
        return (points - self.origin) @ self.map_from_world.T

    def place(self, located: Points) -> Points:
        """Give places of the map and heights as points of the world [m]."""
        return located @ self.map_from_world + self.origin

    def cells_of(self, located: Points) -> tuple[Indices, Indices]:
        """Give the row and column of places; at the rim those of the outermost cell."""
        columns, rows = np.floor(located[:, :2] / self.cell).astype(int).T
        return np.clip(rows, 0, self.shape[0] - 1), np.clip(columns, 0, self.shape[1] - 1)

    def gather(self, located: Points, values: Scalars) -> tuple[Map, Map]:
        """Give the sum of the values of each cell's points, and their number."""
        rows, columns = self.cells_of(located)
        cell, count = rows * self.shape[1] + columns, self.shape[0] * self.shape[1]
        total = np.bincount(cell, values, count).reshape(self.shape)
        return total, np.bincount(cell, minlength=count).reshape(self.shape).astype(float)


def smooth_map(total: Map, weight: Map, *, sigma: float) -> tuple[Map, Map]:
    """Average values over a Gaussian neighbourhood, as far as there are any.

    Args:
        total: Sum of the values in each cell.
        weight: Number of the values in each cell.
        sigma: Standard deviation of the neighbourhood, in cells.

    Returns:
        The average, NaN where there is none; and how many values stand behind it, as if all had
        the same weight.
    """
    values = gaussian_filter(total, sigma, mode="constant", truncate=3.0)
    weights = gaussian_filter(weight, sigma, mode="constant", truncate=3.0)
    there = weights > 1e-6
    mean = np.full(total.shape, np.nan)
    mean[there] = values[there] / weights[there]
    return mean, weights * (4 * np.pi * sigma**2)
