"""Sections as DXF drawings, by ezdxf."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from .atomic import replacing

if TYPE_CHECKING:
    pass

_LAYER = "SECTION"


def save_section_dxf(path: Path, drawing: Sequence[np.ndarray]) -> None:
    """Write a section's lines as polylines in millimetres, DXF R2010, on the layer SECTION.

    Args:
        path: Where the file shall be.
        drawing: Each line in the drawing's x and y [m]; n 2 each.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    from ezdxf import units
    from ezdxf.filemanagement import new

    document = new("R2010", units=units.MM)
    document.layers.add(_LAYER)
    space = document.modelspace()
    for line in drawing:
        is_closed = len(line) > 2 and np.array_equal(line[0], line[-1])
        corners = (line[:-1] if is_closed else line) * 1e3
        space.add_lwpolyline(corners.tolist(), close=is_closed, dxfattribs={"layer": _LAYER})
    with replacing(path) as aside:
        document.saveas(aside)
