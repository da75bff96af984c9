"""A rig, settings and numbers in words."""

import math
from collections.abc import Iterator, Mapping
from typing import Any

from ..optics import equivalent_plane, refractive_index
from ..types.laser import Laser
from ..types.port import FlatPort, Port
from ..types.rig import Rig
from .quantiles import Quantiles

_CHOICE = ("choice", "type")
"""Keys under which a Choice has its name."""


def rig_rows(rig: Rig) -> list[tuple[str, str]]:
    """Describe a rig, one part a row: its name, and what it is like in the units of rig.toml."""
    camera = rig.camera
    (width, height), (fx, fy), (cx, cy) = camera.size, camera.focal_length, camera.principal_point
    view = 2 * math.degrees(math.atan(width / 2 / fx))
    lens = ", ".join(f"{k:g}" for k in camera.distortion) if camera.is_distorted() else "none"
    rows = [
        (
            "camera",
            f"{width} × {height} px, focal length {fx:.1f} and {fy:.1f} px, "
            f"principal point {cx:.1f}, {cy:.1f} px, {view:.0f}° wide in air",
        ),
        ("lens distortion", lens),
    ]
    if camera.port is not None:
        rows.append(("camera's port", _describe_port(camera.port)))
    for number, laser in enumerate(rig.lasers):
        rows.append((f"laser {number}", _describe_laser(laser, rig)))
    rows.append(("wavelength", f"{rig.wavelength * 1e9:g} nm"))
    rows.append(("water", _describe_water(rig)))
    if rig.vehicle_from_camera is not None:
        x, y, z = 1e3 * rig.vehicle_from_camera.translation
        rows.append(("mount", f"camera at {x:.1f}, {y:.1f}, {z:.1f} mm on the vehicle"))
    return rows


def setting_rows(settings: Mapping[str, Any], parent: str = "") -> Iterator[tuple[str, str]]:
    """List settings, one a row; those inside others carry both names."""
    for name, value in settings.items():
        full = f"{parent} · {name}" if parent else str(name)
        if isinstance(value, Mapping):
            inside = {key: kept for key, kept in value.items() if key not in _CHOICE}
            if choice := [str(value[key]) for key in _CHOICE if key in value]:
                yield full, choice[0]
            yield from setting_rows(inside, full)
        elif isinstance(value, list | tuple) and any(isinstance(item, Mapping) for item in value):
            yield from setting_rows({str(n): item for n, item in enumerate(value, start=1)}, full)
        else:
            yield full, _describe_value(value)


def describe_range(spread: Quantiles) -> str:
    """Write the range of a length, from the smallest to the largest, in millimetres."""
    if spread.smallest is None or spread.largest is None:
        return "–"
    return f"{spread.smallest * 1e3:.0f} to {spread.largest * 1e3:.0f} mm"


def _describe_value(value: Any) -> str:
    if value is None:
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, list | tuple):
        return ", ".join(_describe_value(item) for item in value)
    return f"{value:g}" if isinstance(value, float) else str(value)


def _describe_laser(laser: Laser, rig: Rig) -> str:
    plane = equivalent_plane(laser, refractive_index(rig.water, rig.wavelength))
    baseline, angle = Laser(plane, laser.axis).as_baseline_angle()
    port = getattr(laser.sheet, "port", None)
    bent = f"; nearest plane of a sheet bent by {_describe_port(port)}" if port else ""
    return (
        f"baseline {baseline * 1e3:.2f} mm along {laser.axis}, angle {math.degrees(angle):.3f}°"
        f"{bent}"
    )


def _describe_port(port: Port) -> str:
    if isinstance(port, FlatPort):
        layers = " and ".join(f"{p.thickness * 1e3:g} mm of index {p.index:g}" for p in port.layers)
        return f"a flat port at {port.distance * 1e3:g} mm, {layers or 'without thickness'}"
    return (
        f"a dome of inner radius {port.radius * 1e3:g} mm, {port.thickness * 1e3:g} mm of index "
        f"{port.index:g}"
    )


def _describe_water(rig: Rig) -> str:
    water = rig.water
    if water is None:
        return "not stated: the rig is taken as it was calibrated"
    index = refractive_index(water, rig.wavelength)
    if water.index is not None:
        return f"index {index:.5f}, as given"
    return (
        f"{water.temperature_c:g} °C, {water.salinity_psu:g} PSU, {water.depth:g} m deep: "
        f"index {index:.5f}"
    )
