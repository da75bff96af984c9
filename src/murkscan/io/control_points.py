"""Control points: places that a surveyor has measured, and where they lie on a model."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..errors import FormatError
from ..types.arrays import Points, Scalars
from .text_table import TextTable, read_text_table

_COLUMNS = ("name", "easting_m", "northing_m", "height_m", "sigma_mm", "x_m", "y_m", "z_m")
_SHORT = {"easting": "easting_m", "northing": "northing_m", "height": "height_m", "x": "x_m"}
_SHORT |= {"y": "y_m", "z": "z_m"}
"""Names without a unit, which are metres; of sigma the unit must be said."""


@dataclass(frozen=True, eq=False)
class ControlPoints:
    """Control points, one a row."""

    names: tuple[str, ...]
    places: Points
    """Easting, northing and height [m]."""
    sigma: Scalars
    """Standard deviation along each of the three [m]."""
    on_model: Points
    """Where each lies in the model's world [m]."""


def read_control_points(path: Path) -> ControlPoints:
    """Read a table of control points.

    Its first line names the columns, in any order: name, easting_m, northing_m, height_m, sigma_mm
    (or sigma_m), and x_m, y_m, z_m, the place on the model. Others are passed over.

    Raises:
        FormatError: The file is missing or no such table; the message names the line.
    """
    table = read_text_table(path, "file of control points")
    names = [_SHORT.get(name.lower(), name.lower()) for name in table.names]
    scale = 1e-3
    if "sigma_m" in names and "sigma_mm" not in names:
        names[names.index("sigma_m")], scale = "sigma_mm", 1.0
    if missing := [name for name in _COLUMNS if name not in names]:
        unit = "; of sigma the unit must be said" if "sigma" in names else ""
        raise FormatError(
            f"{path} lacks the column {missing[0]}{unit}. Its first line names the columns: "
            f"{','.join(_COLUMNS)}."
        )
    where = {name: names.index(name) for name in _COLUMNS}
    called = tuple(
        _cell(path, table, row, where["name"]) or str(row + 1) for row in range(len(table.rows))
    )
    if twice := [name for name in called if called.count(name) > 1]:
        raise FormatError(f"{path} has the control point {twice[0]} twice.")
    columns = {
        name: np.array([_number(path, table, row, at, name) for row in range(len(table.rows))])
        for name, at in where.items()
        if name != "name"
    }
    sigma = scale * columns["sigma_mm"]
    if len(sigma) and not (sigma > 0).all():
        line = table.lines[int(np.argmin(sigma > 0))]
        raise FormatError(f"{path} has a sigma that is not above 0 in line {line}.")
    return ControlPoints(
        called, _stack(columns, _COLUMNS[1:4]), sigma, _stack(columns, _COLUMNS[5:])
    )


def _stack(columns: dict[str, np.ndarray], names: tuple[str, ...]) -> Points:
    return np.stack([columns[name] for name in names], axis=1).astype(float)


def _cell(path: Path, table: TextTable, row: int, at: int) -> str:
    if at >= len(table.rows[row]):
        raise FormatError(f"{path} has too few columns in line {table.lines[row]}.")
    return table.rows[row][at]


def _number(path: Path, table: TextTable, row: int, at: int, name: str) -> float:
    cell = _cell(path, table, row, at)
    try:
        value = float(cell)
    except ValueError:
        value = float("nan")
    if not np.isfinite(value):
        raise FormatError(f"{path} has {cell!r} for {name} in line {table.lines[row]}: no number.")
    return value
