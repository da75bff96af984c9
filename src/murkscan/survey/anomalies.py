"""The list of a scan's dents and bumps: a table, a drawing, and a picture of each."""

from collections.abc import Sequence

import numpy as np

from ..errors import NotEnoughData
from ..io.anomaly_dxf import save_anomalies_dxf
from ..io.images import write_image
from ..io.wall_files import Cell, save_table
from ..measure import Ball, cut_out
from ..project import StageFiles
from ..types.dent import Dent
from ..types.georeference import Georeference
from ..types.mesh import Mesh
from ..view.render import render
from ..view.values import SignedValues
from ..view.views import View

MOST_PICTURES = 30
"""Anomalies of which a picture is drawn: as many as the report shows."""
_HEADS = (
    "number", "kind", "depth_mm", "half_width_95_mm", "diameter_mm", "volume_cm3", "x_m", "y_m",
    "z_m",
)  # fmt: skip
_AROUND = 1.25
"""How far a picture reaches from an anomaly's middle, in its diameters."""
_NEAREST = 0.02
"""The same at least [m]."""
_SIZE = (640, 480)


def list_dents(dents: Sequence[Dent], place: Georeference | None) -> list[dict[str, Cell]]:
    """Give the numbers of each dent, by the names of the table's columns.

    Args:
        dents: The dents and bumps, in order.
        place: Where the scan lies, if that is known.
    """
    heads = [*_HEADS, *(() if place is None else place.heads)]
    rows: list[dict[str, Cell]] = []
    for number, one in enumerate(dents, 1):
        told: list[Cell] = [] if place is None else [*place.tell(one.place[None])[0]]
        row: list[Cell] = [
            number,
            "dent" if one.depth.value > 0 else "bump",
            round(1e3 * one.depth.value, 3),
            round(1e3 * one.depth.half_width, 3),
            round(1e3 * one.diameter.value, 1),
            round(1e6 * one.volume.value, 3),
            *np.round(one.place, 4).tolist(),
            *told,
        ]
        rows.append(dict(zip(heads, row, strict=True)))
    return rows


def save_dents(
    files: StageFiles,
    dents: Sequence[Dent],
    place: Georeference | None,
    *,
    surface: Mesh,
    colours: SignedValues,
    view: View,
) -> dict[str, object]:
    """Write NAME-anomalies.csv, NAME.dxf and NAME-1.png and so on.

    Args:
        files: Of the measurement.
        dents: The dents and bumps, in order.
        place: Where the scan lies; the drawing is in its coordinates, or in the scan's own world.
        surface: The scan's surface, in the world.
        colours: Its deviations.
        view: From where it is drawn.

    Returns:
        What the measurement says of them: the rows of the table, and names of the pictures.
    """
    rows, label = list_dents(dents, place), files.label
    heads = [*_HEADS, *(() if place is None else place.heads)]
    with files.making(f"{label}-anomalies.csv") as path:
        save_table(path, heads, [list(row.values()) for row in rows])
    circles = [
        (
            str(n),
            one.place if place is None else place.place(one.place[None])[0],
            one.diameter.value,
        )
        for n, one in enumerate(dents, 1)
    ]
    with files.making(f"{label}.dxf") as path:
        save_anomalies_dxf(path, circles)
    pictures = []
    for number, one in enumerate(dents[:MOST_PICTURES], 1):
        x, y, z = one.place.tolist()
        around = Ball((x, y, z), max(_AROUND * one.diameter.value, _NEAREST))
        try:
            part = cut_out(surface, around)
        except NotEnoughData:  # beside the surface
            continue
        with files.making(f"{label}-{number}.png") as path:
            write_image(path, render(part, view, colours=colours, size=_SIZE))
        pictures.append(f"{label}-{number}.png")
    return {"anomalies": rows, "pictures": pictures}
