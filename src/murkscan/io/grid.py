"""Coordinate systems of maps, in which a model is delivered."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import InputError
from ..types.arrays import Vector
from .projection import find_system, import_pyproj

_EARTH = 6_371_008.8
"""Mean radius of the Earth [m] (IUGG)."""
_OUTSIDE = 5.0
"""Degrees that places may lie beyond the area for which a system was made."""


@dataclass(frozen=True)
class Grid:
    """A coordinate system at one place."""

    name: str
    """As EPSG:N and by its name."""
    wkt: str
    """As well-known text, in version 1 where that can say it: LAS asks for it."""
    scale: float
    """Length in the grid of a metre on the ground."""
    has_heights: bool
    """Whether it says what heights count from."""


def find_grid(crs: str, place: Vector) -> Grid:
    """Find a coordinate system, and how long its metre is at a place.

    Args:
        crs: A projected one in metres, as EPSG:N, or with that of the heights as EPSG:N+M.
        place: Easting, northing and height there [m].

    Raises:
        InputError: There is no such system, its unit is not the metre, its heights count down, or
            the place lies far outside of it.
        MissingDependency: pyproj is not installed.
    """
    pyproj = import_pyproj("A coordinate system")
    system = find_system(pyproj, crs)
    heights = list(system.axis_info[2:])
    if any(axis.direction != "up" or axis.unit_name != "metre" for axis in heights):
        raise InputError(
            f"The heights of {crs} ({system.name}) do not count upwards in metres; name a system "
            "whose do."
        )
    flat = system.sub_crs_list[0] if system.is_compound else system
    scale = _scale_at(pyproj, flat, place, crs)
    return Grid(
        f"{crs} ({system.name})",
        _as_wkt(pyproj, system),
        scale * _EARTH / (_EARTH + float(place[2])),
        bool(heights),
    )


def _scale_at(pyproj: Any, flat: Any, place: Vector, crs: str) -> float:
    """Compute the projection's scale along the meridian, which is that of every direction."""
    to_globe = pyproj.Transformer.from_crs(flat, flat.geodetic_crs, always_xy=True)
    longitude, latitude = to_globe.transform(float(place[0]), float(place[1]))
    area = flat.area_of_use
    if not np.isfinite([longitude, latitude]).all() or (
        area and _is_far(longitude, latitude, area)
    ):
        raise InputError(
            f"The control points lie near easting {place[0]:.0f} m, northing {place[1]:.0f} m, far "
            f"outside of {crs} ({flat.name}); name another --crs, or exchange the two columns."
        )
    factors = pyproj.Proj(flat).get_factors(longitude, latitude)
    return float(factors.meridional_scale)


def _is_far(longitude: float, latitude: float, area: Any) -> bool:
    middle, half = (area.west + area.east) / 2, (area.east - area.west) / 2
    if area.west > area.east:  # across the antimeridian
        middle, half = middle + 180, half + 180
    aside = abs((longitude - middle + 180) % 360 - 180) - half
    above = max(area.south - latitude, latitude - area.north)
    return bool(max(aside, above) > _OUTSIDE)


def _as_wkt(pyproj: Any, system: Any) -> str:
    try:
        text = system.to_wkt("WKT1_GDAL")
    except pyproj.exceptions.CRSError:
        text = None
    return str(text or system.to_wkt())
