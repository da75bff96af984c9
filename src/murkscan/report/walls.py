"""Walls that were drawn in elevation: the picture, and what stands out of each."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ..page import Block, Gallery, Note, Picture, Section, Table

_SHOWN = 30
"""Anomalies in the table, at most; the measurement's file has them all."""
_COLUMNS = {
    "number": "number",
    "along_m": "along [m]",
    "height_m": "height [m]",
    "distance_mm": "out of the wall [mm]",
    "half_width_95_mm": "± 95 % [mm]",
    "width_mm": "width [mm]",
    "rise_mm": "height [mm]",
    "area_m2": "area [m²]",
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


@dataclass(frozen=True)
class DrawnWall:
    """A wall that was measured."""

    name: str
    """Of the measurement."""
    anomalies: Sequence[Mapping[str, float]]
    """By the keys of its table, the largest first."""


def wall_sections(walls: Sequence[DrawnWall]) -> list[Section]:
    """Show each wall."""
    return [Section(f"Wall in elevation: {wall.name}", _blocks(wall)) for wall in walls]


def walls_as_plain(walls: Sequence[DrawnWall]) -> list[dict[str, Any]]:
    """Give the same as plain values."""
    return [
        {"name": wall.name, "anomalies": [dict(one) for one in wall.anomalies]} for wall in walls
    ]


def _blocks(wall: DrawnWall) -> list[Block]:
    picture = Picture(f"../measure/{wall.name}.png", "distances out of the wall, and its curves")
    blocks: list[Block] = [Gallery([picture], is_first_large=True)]
    if not wall.anomalies:
        return [*blocks, Note("No part of the wall is off by more than was asked for.")]
    keys = [key for key in _COLUMNS if key in wall.anomalies[0]]
    rows = [[_as_cell(key, one[key]) for key in keys] for one in wall.anomalies[:_SHOWN]]
    blocks.append(Table(rows, head=tuple(_COLUMNS[key] for key in keys)))
    if len(wall.anomalies) > _SHOWN:
        rest = len(wall.anomalies) - _SHOWN
        blocks.append(Note(f"And {rest} more, listed in measure/{wall.name}-anomalies.csv."))
    return blocks


def _as_cell(key: str, value: float) -> str | float:
    """Give a number; places in a grid to the millimetre, whatever their size."""
    return f"{value:.3f}" if key in ("easting_m", "northing_m") else value
