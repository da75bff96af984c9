"""Deflection curves and anomalies of a wall, as tables and as a drawing."""

import csv
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from ..types.arrays import Points
from .atomic import replacing

Cell = str | int | float


def save_table(path: Path, head: Sequence[str], rows: Iterable[Sequence[Cell]]) -> None:
    """Write a table as CSV, below a line with the names of its columns.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    with replacing(path) as aside, aside.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(head)
        writer.writerows(rows)


def save_wall_dxf(
    path: Path,
    *,
    curves: Sequence[tuple[float, Points]],
    boxes: Sequence[tuple[str, tuple[float, float, float, float]]],
) -> None:
    """Write a wall's elevation as DXF R2010, in millimetres: along to the right, height upwards.

    Args:
        path: The file.
        curves: Where each section is along the wall, and along, height and distance of its places
            [m]. A curve lies beside its section by the distance, to scale, on the layer CURVES; the
            section itself on SECTIONS.
        boxes: Name of each anomaly, and its left, lower, right and upper edge [m], on ANOMALIES.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    from ezdxf import units
    from ezdxf.filemanagement import new

    document = new("R2010", units=units.MM)
    for name, colour in (("SECTIONS", 8), ("CURVES", 5), ("ANOMALIES", 1)):
        document.layers.add(name, color=colour)
    space = document.modelspace()
    for along, places in curves:
        ends = [(along, float(places[end, 1])) for end in (0, -1)]
        space.add_lwpolyline(1e3 * np.array(ends), dxfattribs={"layer": "SECTIONS"})
        line = np.stack([along + places[:, 2], places[:, 1]], axis=1)
        space.add_lwpolyline(1e3 * line, dxfattribs={"layer": "CURVES"})
    for name, (left, low, right, high) in boxes:
        corners = 1e3 * np.array([(left, low), (right, low), (right, high), (left, high)])
        space.add_lwpolyline(corners, close=True, dxfattribs={"layer": "ANOMALIES"})
        text = space.add_text(name, height=40.0, dxfattribs={"layer": "ANOMALIES"})
        text.set_placement((1e3 * left, 1e3 * high + 10.0))
    with replacing(path) as aside:
        document.saveas(aside)
