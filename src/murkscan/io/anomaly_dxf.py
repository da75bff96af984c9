"""Dents and bumps as a drawing in space."""

from collections.abc import Sequence
from pathlib import Path

from ..types.arrays import Vector
from .atomic import replacing

_LETTERS = 0.3
"""Height of a number as a share of its circle's diameter."""
_SMALLEST = 10.0
"""Height of a number at least [mm]."""


def save_anomalies_dxf(path: Path, circles: Sequence[tuple[str, Vector, float]]) -> None:
    """Write places as DXF R2010, in millimetres: a point, a level circle and a number for each.

    Args:
        path: The file.
        circles: Name, place [m] and diameter [m] of each; on the layer ANOMALIES.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    from ezdxf import units
    from ezdxf.filemanagement import new

    document = new("R2010", units=units.MM)
    document.layers.add("ANOMALIES", color=1)
    space = document.modelspace()
    for name, place, diameter in circles:
        x, y, z = (1e3 * place).tolist()
        how = {"layer": "ANOMALIES"}
        space.add_point((x, y, z), dxfattribs=how)
        space.add_circle((x, y, z), 500 * diameter, dxfattribs=how)
        height = max(1e3 * _LETTERS * diameter, _SMALLEST)
        text = space.add_text(name, height=height, dxfattribs=how)
        text.set_placement((x + 500 * diameter, y, z))
    with replacing(path) as aside:
        document.saveas(aside)
