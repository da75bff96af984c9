"""Control points: places on the Earth or on a ship, and where they lie on a model."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..errors import FormatError
from ..types.arrays import Points, Scalars
from ..types.hull import HullFrame
from .text_table import TextTable, read_text_table

_ON_MODEL = ("x_m", "y_m", "z_m")
_OF_ALL = ("sigma_mm", *_ON_MODEL)
"""Columns of every table, beside name and place; those of the model may be left out where a column
"marker" tells."""
_LARGEST_MARKER = 1_000_000
_SIDES = (
    (("starboard", "stbd", "s"), 1.0),
    (("port", "p"), -1.0),
    (("centreline", "centerline", "centre", "center", "c", "cl"), 0.0),
)
"""Words for a side, and the sign of what lies there."""
_SHORT = {"easting": "easting_m", "northing": "northing_m", "height": "height_m", "x": "x_m"}
_SHORT |= {"y": "y_m", "z": "z_m"}
"""Names without a unit, which are metres; of sigma the unit must be said."""


@dataclass(frozen=True, eq=False)
class ControlPoints:
    """Control points, one a row."""

    names: tuple[str, ...]
    places: Points
    """Easting, northing and height, or on a ship aft, to starboard and up [m]."""
    sigma: Scalars
    """Standard deviation along each of the three [m]."""
    on_model: Points
    """Where each lies in the model's world [m]; NaN where a marker tells."""
    markers: tuple[int | None, ...]
    """Number of the marker that tells where each lies; None where the table does."""


def read_control_points(path: Path) -> ControlPoints:
    """Read a table of control points.

    Its first line names the columns, in any order: name, easting_m, northing_m, height_m, sigma_mm
    (or sigma_m), and x_m, y_m, z_m, the place on the model, or marker, the number of one that was
    seen there. Others are passed over.

    Raises:
        FormatError: The file is missing or no such table; the message names the line.
    """
    table = _Table.read(path, ("easting_m", "northing_m", "height_m"))
    return table.as_points(table.stack("easting_m", "northing_m", "height_m"))


def read_hull_points(path: Path, hull: HullFrame) -> ControlPoints:
    """Read a table of named points of a ship.

    Its first line names the columns, in any order: name, frame (or from_bow_m, where no distance
    of the frames is given), height_m, from_centreline_m, side (port, starboard or centreline),
    sigma_mm (or sigma_m), and x_m, y_m, z_m, the place on the model, or marker, the number of one
    that was seen there. Others are passed over.

    Args:
        path: The table.
        hull: How its frames and heights count.

    Returns:
        The points; their places are aft, to starboard and up [m].

    Raises:
        FormatError: The file is missing or no such table; the message names the line.
    """
    station = hull.heads[0]
    table = _Table.read(path, (station, "height_m", "from_centreline_m", "side"))
    aft = [hull.aft_of(number) for number in table.numbers(station).tolist()]
    aside = table.numbers("from_centreline_m")
    starboard = np.array([table.side_of(row) for row in range(len(aside))]) * aside
    return table.as_points(np.stack([np.array(aft), starboard, table.numbers("height_m")], axis=1))


@dataclass(frozen=True)
class _Table:
    """A table, the file that it is of, and where in it each column is."""

    path: Path
    table: TextTable
    where: Mapping[str, int]
    sigma_scale: float

    @classmethod
    def read(cls, path: Path, places: Sequence[str]) -> "_Table":
        table = read_text_table(path, "file of control points")
        wanted = ("name", *places, *_OF_ALL)
        names = [_SHORT.get(name.lower(), name.lower()) for name in table.names]
        scale = 1e-3
        if "sigma_m" in names and "sigma_mm" not in names:
            names[names.index("sigma_m")], scale = "sigma_mm", 1.0
        if "marker" in names:
            wanted = tuple(name for name in wanted if name in names or name not in _ON_MODEL)
            wanted = (*wanted, "marker")
        if missing := [name for name in wanted if name not in names]:
            unit = "; of sigma the unit must be said" if "sigma" in names else ""
            raise FormatError(
                f"{path} lacks the column {missing[0]}{unit}. Its first line names the columns: "
                f"{','.join(wanted)}."
            )
        return cls(path, table, {name: names.index(name) for name in wanted}, scale)

    def as_points(self, places: Points) -> ControlPoints:
        """Give the points, with the columns that all tables have."""
        count = len(self.table.rows)
        called = tuple(self.cell("name", row) or str(row + 1) for row in range(count))
        if twice := [name for name in called if called.count(name) > 1]:
            raise FormatError(f"{self.path} has the control point {twice[0]} twice.")
        sigma = self.sigma_scale * self.numbers("sigma_mm")
        if count and not (sigma > 0).all():
            line = self.table.lines[int(np.argmin(sigma > 0))]
            raise FormatError(f"{self.path} has a sigma that is not above 0 in line {line}.")
        rows = [self._on_model(row) for row in range(count)]
        on_model = np.array([place for place, _ in rows], float).reshape(-1, 3)
        return ControlPoints(called, places, sigma, on_model, tuple(marker for _, marker in rows))

    def _on_model(self, row: int) -> tuple[list[float], int | None]:
        """Give the place on the model that a row has, or the marker that tells it."""
        marker = self.cell("marker", row) if "marker" in self.where else ""
        is_placed = any(self.cell(name, row) for name in _ON_MODEL if name in self.where)
        if not marker or is_placed:
            return [self._number(name, row) for name in _ON_MODEL], None
        if not marker.isdecimal() or int(marker) > _LARGEST_MARKER:
            line = self.table.lines[row]
            raise FormatError(f"{self.path} has {marker!r} for marker in line {line}: no number.")
        return [float("nan")] * 3, int(marker)

    def stack(self, *names: str) -> Points:
        return np.stack([self.numbers(name) for name in names], axis=1)

    def numbers(self, name: str) -> Scalars:
        return np.array([self._number(name, row) for row in range(len(self.table.rows))], float)

    def side_of(self, row: int) -> float:
        """Give 1 for starboard, -1 for port, 0 for the centreline."""
        cell = self.cell("side", row)
        for words, sign in _SIDES:
            if cell.lower() in words:
                return sign
        raise FormatError(
            f"{self.path} has {cell!r} for side in line {self.table.lines[row]}; write port, "
            "starboard or centreline."
        )

    def cell(self, name: str, row: int) -> str:
        cells, at = self.table.rows[row], self.where[name]
        if at >= len(cells):
            raise FormatError(f"{self.path} has too few columns in line {self.table.lines[row]}.")
        return cells[at]

    def _number(self, name: str, row: int) -> float:
        if name not in self.where:
            raise FormatError(
                f"{self.path} has neither a marker nor {', '.join(_ON_MODEL)} in line "
                f"{self.table.lines[row]}."
            )
        cell = self.cell(name, row)
        try:
            value = float(cell)
        except ValueError:
            value = float("nan")
        if not np.isfinite(value):
            line = self.table.lines[row]
            raise FormatError(f"{self.path} has {cell!r} for {name} in line {line}: no number.")
        return value
