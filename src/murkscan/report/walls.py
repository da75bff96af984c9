"""What was found on walls and hulls: anomalies, with place, size and a picture of each."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from ..page import Block, Gallery, Note, Picture, Section, Table

_SHOWN = 30
"""Anomalies in the table, at most; the measurement's file has them all."""
_COLUMNS = {
    "number": "number",
    "kind": "what",
    "depth_mm": "depth [mm]",
    "diameter_mm": "diameter [mm]",
    "volume_cm3": "volume [cm³]",
    "along_m": "along [m]",
    "height_m": "height [m]",
    "distance_mm": "out of the wall [mm]",
    "half_width_95_mm": "± 95 % [mm]",
    "width_mm": "width [mm]",
    "rise_mm": "height [mm]",
    "area_m2": "area [m²]",
    "x_m": "x [m]",
    "y_m": "y [m]",
    "z_m": "z [m]",
    "easting_m": "easting [m]",
    "northing_m": "northing [m]",
    "frame": "frame",
    "from_bow_m": "from the bow [m]",
    "above_keel_m": "above the keel [m]",
    "above_waterline_m": "above the waterline [m]",
    "side": "side",
    "from_centreline_m": "from the centreline [m]",
}
"""Keys of an anomaly, and what stands above them."""
_IN_MODEL = ("x_m", "y_m", "z_m")
"""Those that are left out where another place is told."""


@dataclass(frozen=True)
class DrawnWall:
    """A wall, or the dents of a hull, that were measured."""

    name: str
    """Of the measurement."""
    anomalies: Sequence[Mapping[str, str | float]]
    """By the keys of its table, the largest first."""
    pictures: Sequence[str] = ()
    """Files of one picture for each of the first anomalies, in OUT/measure."""
    kind: Literal["wall", "dents"] = "wall"
    """Which measurement it is."""


def wall_sections(walls: Sequence[DrawnWall]) -> list[Section]:
    """Show each wall."""
    titles = {"wall": "Wall in elevation", "dents": "Dents and bumps"}
    return [Section(f"{titles[wall.kind]}: {wall.name}", _blocks(wall)) for wall in walls]


def walls_as_plain(walls: Sequence[DrawnWall]) -> list[dict[str, Any]]:
    """Give the same as plain values."""
    return [
        {
            "name": wall.name,
            "kind": wall.kind,
            "anomalies": [dict(one) for one in wall.anomalies],
            "pictures": [f"../measure/{name}" for name in wall.pictures],
        }
        for wall in walls
    ]


def _blocks(wall: DrawnWall) -> list[Block]:
    blocks: list[Block] = [Gallery([_overview(wall)], is_first_large=True)]
    if not wall.anomalies:
        none = "No part of the wall is off by more than was asked for."
        return [*blocks, Note(none if wall.kind == "wall" else "No dent or bump was found.")]
    there = wall.anomalies[0]
    is_placed = "along_m" in there or "easting_m" in there or "side" in there
    keys = [key for key in _COLUMNS if key in there and not (is_placed and key in _IN_MODEL)]
    rows = [[_as_cell(key, one[key]) for key in keys] for one in wall.anomalies[:_SHOWN]]
    blocks.append(Table(rows, head=tuple(_COLUMNS[key] for key in keys)))
    if len(wall.anomalies) > _SHOWN:
        rest = len(wall.anomalies) - _SHOWN
        blocks.append(Note(f"And {rest} more, listed in measure/{wall.name}-anomalies.csv."))
    shown = [
        Picture(f"../measure/{name}", f"number {name.removesuffix('.png').rpartition('-')[2]}")
        for name in wall.pictures
    ]
    return [*blocks, Gallery(shown)] if shown else blocks


def _overview(wall: DrawnWall) -> Picture:
    if wall.kind == "wall":
        return Picture(f"../measure/{wall.name}.png", "distances out of the wall, and its curves")
    return Picture(f"../measure/{wall.name}-front.png", "deviations, as the camera sees the hull")


def _as_cell(key: str, value: str | float) -> str | float:
    """Give a number; places in a grid to the millimetre, whatever their size."""
    is_place = key in ("easting_m", "northing_m")
    return f"{value:.3f}" if is_place and not isinstance(value, str) else value
