"""Latitude and longitude in metres, in a coordinate system with a name."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import InputError, MissingDependency
from ..types.arrays import Scalars

_GLOBE = "EPSG:4326"
"""WGS 84, which GNSS and MAVLink speak."""


@dataclass(frozen=True, eq=False)
class Projected:
    """Places in metres."""

    east: Scalars
    north: Scalars
    name: str
    """The coordinate system, as EPSG:N and by its name."""
    convergence: float
    """Angle from true north to the grid's north in the middle, clockwise [rad]."""
    scale: float
    """Length in the grid of a metre on the ground, in the middle."""


def project_places(latitude: Scalars, longitude: Scalars, crs: str | None) -> Projected:
    """Project places to the plane.

    Args:
        latitude: On WGS 84 [degrees].
        longitude: Likewise.
        crs: A projected coordinate system in metres, as EPSG:N; UTM's zone of the first place
            where none is given.

    Raises:
        InputError: There is no such coordinate system, or its unit is not the metre.
        MissingDependency: pyproj is not installed.
    """
    pyproj = import_pyproj("Making metres of latitude and longitude")
    system = find_system(pyproj, crs or _utm(float(latitude[0]), float(longitude[0])))
    to_grid = pyproj.Transformer.from_crs(_GLOBE, system, always_xy=True)
    east, north = to_grid.transform(longitude, latitude)
    if not (np.isfinite(east).all() and np.isfinite(north).all()):
        raise InputError(f"The places of the log lie outside of {system.name}; name another --crs.")
    factors = pyproj.Proj(system).get_factors(float(longitude.mean()), float(latitude.mean()))
    return Projected(
        np.asarray(east, float),
        np.asarray(north, float),
        f"{':'.join(system.to_authority() or ('', ''))} ({system.name})",
        float(np.radians(factors.meridian_convergence)),
        float(factors.meridional_scale),
    )


def import_pyproj(what: str) -> Any:
    """Import pyproj.

    Args:
        what: What is done by it, to begin the error with.

    Raises:
        MissingDependency: It is not installed.
    """
    try:
        import pyproj
    except ImportError as error:
        raise MissingDependency.of(what, "pyproj", "dive") from error
    return pyproj


def find_system(pyproj: Any, crs: str) -> Any:
    """Find a projected coordinate system in metres.

    Args:
        pyproj: The library.
        crs: The system, as EPSG:N.

    Raises:
        InputError: There is none of this name, or it is none in metres.
    """
    try:
        system = pyproj.CRS.from_user_input(crs)
    except pyproj.exceptions.CRSError as error:
        raise InputError(
            f"There is no coordinate system {crs!r}; give one as EPSG:32632, which is UTM zone 32 "
            "north."
        ) from error
    if not system.is_projected or {axis.unit_name for axis in system.axis_info[:2]} != {"metre"}:
        raise InputError(
            f"{crs} ({system.name}) is no plane in metres; give a projected coordinate system, "
            "such as EPSG:32632."
        )
    return system


def _utm(latitude: float, longitude: float) -> str:
    """Name UTM's zone of a place, on WGS 84."""
    zone = int((longitude + 180) // 6) % 60 + 1
    return f"EPSG:{32600 + zone if latitude >= 0 else 32700 + zone}"
