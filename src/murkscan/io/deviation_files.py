"""A scan's distances from a reference: as points with a scalar, and as a table."""

import csv
import re
from pathlib import Path

import numpy as np

from ..errors import FormatError
from ..types.arrays import Indices, Points, Scalars
from ..types.deviation import Deviation
from .atomic import replacing

_COLUMNS = ("x_m", "y_m", "z_m", "deviation_mm", "sigma_mm")
_PROPERTIES = [(name, "<f8") for name in ("x", "y", "z")] + [
    (name, "<f4") for name in ("nx", "ny", "nz", "deviation", "sigma")
]
_PROPERTIES += [("point", "<i4")]
_TYPES = {"<f8": "double", "<f4": "float", "<i4": "int"}
MOST_ROWS = 200_000
"""Rows of a table that spreadsheets open without complaint."""


def save_deviation_ply(
    path: Path, points: Points, deviation: Deviation, sigma: Scalars, rows: Indices
) -> None:
    """Write points with the scalars `deviation` and `sigma` [m], as CloudCompare shows them.

    Args:
        path: Where the file shall be.
        points: The points [m]; those without a deviation are left out.
        deviation: Their distances from the reference.
        sigma: Standard deviation of each distance [m].
        rows: Number of each point in the scan's cloud, which `point` is.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    known = np.isfinite(deviation.values)
    table = np.empty(int(known.sum()), _PROPERTIES)
    for axis, name in enumerate("xyz"):
        table[name] = points[known, axis]
        table["n" + name] = deviation.normals[known, axis]
    table["deviation"], table["sigma"] = deviation.values[known], sigma[known]
    table["point"] = rows[known]
    header = ["ply", "format binary_little_endian 1.0", "comment murkscan: metres"]
    header += [f"element vertex {len(table)}"]
    header += [f"property {_TYPES[kind]} {name}" for name, kind in _PROPERTIES]
    with replacing(path) as aside, aside.open("wb") as file:
        file.write("\n".join([*header, "end_header", ""]).encode("ascii"))
        file.write(table.data)


def save_deviation_csv(path: Path, points: Points, values: Scalars, sigma: Scalars) -> int:
    """Write a signed table; of more than 200,000 points every so many.

    Args:
        path: Where the file shall be.
        points: The points [m]; those without a deviation are left out.
        values: Their distances from the reference [m].
        sigma: Standard deviation of each [m].

    Returns:
        How many points stand for one row.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    known = np.flatnonzero(np.isfinite(values))
    step = -(-len(known) // MOST_ROWS)
    with replacing(path) as aside, aside.open("w", newline="", encoding="utf-8") as file:
        write = csv.writer(file)
        write.writerow(_COLUMNS)
        for i in known[:: max(step, 1)]:
            place = (f"{part:.6f}" for part in points[i])
            write.writerow([*place, f"{values[i] * 1e3:.4f}", f"{sigma[i] * 1e3:.4f}"])
    return max(step, 1)


def load_deviation_ply(path: Path) -> tuple[Points, Scalars, Indices]:
    """Read what `save_deviation_ply` wrote: points, their deviations [m], their numbers.

    Raises:
        FormatError: It is no such file, or is cut off.
        FileNotFoundError: There is no such file.
    """
    head, _, body = path.read_bytes().partition(b"end_header\n")
    count = re.search(rb"element vertex (\d+)", head)
    kind = np.dtype(_PROPERTIES)
    if count is None or len(body) != int(count[1]) * kind.itemsize:
        raise FormatError(f"{path} is no cloud of deviations, or is cut off; measure it again.")
    rows = np.frombuffer(body, kind)
    points = np.stack([rows[axis] for axis in "xyz"], axis=1)
    return points, rows["deviation"].astype(float), rows["point"].astype(np.int64)
