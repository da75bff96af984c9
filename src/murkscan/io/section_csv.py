"""Sections as tables: every corner of every line, with its standard deviation."""

import csv
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ..types.arrays import Points, Scalars
from ..types.georeference import Georeference
from ..types.hull import Cell
from .atomic import replacing

_COLUMNS = ("line", "x_mm", "y_mm", "sigma_mm", "world_x_m", "world_y_m", "world_z_m")


def save_section_csv(
    path: Path,
    drawing: Sequence[np.ndarray],
    lines: Sequence[Points],
    sigmas: Sequence[Scalars],
    *,
    place: Georeference | None = None,
) -> None:
    """Write the corners of a section's lines.

    Args:
        path: Where the file shall be.
        drawing: Each line in the drawing's x and y [m]; n 2 each.
        lines: The same in the world [m].
        sigmas: Standard deviation of each corner across the surface [m].
        place: Where the world lies, if that is known: each corner's place is told there, too.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    with replacing(path) as aside, aside.open("w", newline="", encoding="utf-8") as file:
        write = csv.writer(file)
        write.writerow((*_COLUMNS, *(() if place is None else place.heads)))
        for number, (flat, line, sigma) in enumerate(zip(drawing, lines, sigmas, strict=True)):
            told: list[list[Cell]] = [[]] * len(line) if place is None else place.tell(line)
            for (x, y), corner, s, more in zip(flat * 1e3, line, sigma * 1e3, told, strict=True):
                world = (f"{part:.7f}" for part in corner)
                write.writerow([number, f"{x:.4f}", f"{y:.4f}", f"{s:.4f}", *world, *more])
