"""Rasters of one number a cell as GeoTIFF, which GIS programs lay in place."""

from pathlib import Path

import numpy as np
from jaxtyping import Float

from .atomic import replacing

_SCALE, _TIE, _KEYS, _TEXTS, _NONE = 33550, 33922, 34735, 34737, 42113
"""Tags of GeoTIFF 1.1 (OGC 19-008), and GDAL's for a cell without a value."""
_MODEL, _RASTER, _CITATION, _UNIT = 1024, 1025, 1026, 3076
_OWN, _AREA, _METRE = 32767, 1, 9001
"""A system of its own; cells are areas; lengths are metres."""
_EMPTY = -9999.0


def save_geotiff(
    path: Path,
    values: Float[np.ndarray, "h w"],
    *,
    corner: tuple[float, float],
    cell: float,
    system: str,
) -> None:
    """Write a raster in a plane system of its own, in metres.

    Args:
        path: The file.
        values: One number a cell, row 0 on top; NaN where there is none.
        corner: x and y of the outer corner of the first cell [m]; y goes upwards.
        cell: Edge of a cell [m].
        system: What the system is, in words; in ASCII.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    from PIL import Image, TiffImagePlugin

    words = system.encode("ascii", "replace").decode() + "|"
    keys = [
        (_MODEL, 0, 1, _OWN),
        (_RASTER, 0, 1, _AREA),
        (_CITATION, _TEXTS, len(words), 0),
        (_UNIT, 0, 1, _METRE),
    ]
    numbers = [1, 1, 0, len(keys), *(number for key in keys for number in key)]
    tags = TiffImagePlugin.ImageFileDirectory_v2()
    for tag, kind, content in (
        (_SCALE, 12, (cell, cell, 0.0)),
        (_TIE, 12, (0.0, 0.0, 0.0, *corner, 0.0)),
        (_KEYS, 3, tuple(numbers)),
        (_TEXTS, 2, words),
        (_NONE, 2, f"{_EMPTY:g}"),
    ):
        tags.tagtype[tag] = kind
        tags[tag] = content
    filled = np.where(np.isfinite(values), values, _EMPTY).astype(np.float32)
    with replacing(path) as aside:
        Image.fromarray(filled).save(aside, "TIFF", tiffinfo=tags, compression="tiff_deflate")
