"""A rig as the tables of rig.toml; what `rig_tables` inverts."""

from typing import Any

import numpy as np

from ..types.arrays import Vector
from ..types.camera import Camera
from ..types.laser import Fan, Laser
from ..types.port import FlatPort, Port
from ..types.pose import Pose
from ..types.rig import Rig
from ..types.rig_covariance import RigCovariance
from ..types.water import Water
from .navigation_table import navigation_table


def as_tables(rig: Rig) -> dict[str, Any]:
    """Give a rig as the tables of a rig file."""
    tables: dict[str, Any] = {
        "format": 1,
        "wavelength_nm": round(rig.wavelength * 1e9, 3),
        "camera": camera_table(rig.camera),
        "laser": [laser_table(laser) for laser in rig.lasers],
    }
    if rig.water is not None:
        tables["water"] = water_table(rig.water)
    if rig.vehicle_from_camera is not None:
        tables["mount"] = mount_table(rig.vehicle_from_camera)
    if rig.navigation is not None:
        tables["navigation"] = navigation_table(rig.navigation)
    if rig.covariance.names:
        tables["calibration"] = {"covariance": covariance_table(rig.covariance)}
    return tables


def covariance_table(covariance: RigCovariance) -> dict[str, Any]:
    """Give [calibration.covariance]; its numbers are in px, m and rad, as `units` says."""
    return {
        "parameters": list(covariance.names),
        "units": list(covariance.units),
        # All digits: of parameters that nearly vary as one, little is left but the last.
        "matrix": covariance.matrix.tolist(),
    }


def mount_table(mount: Pose) -> dict[str, Any]:
    """Give [mount]."""
    return {
        "translation_mm": (mount.translation * 1e3).tolist(),
        "quaternion_wxyz": mount.as_quaternion()[0].tolist(),
    }


def camera_table(camera: Camera) -> dict[str, Any]:
    """Give [camera], with [camera.port] where there is one."""
    table: dict[str, Any] = {
        "size": list(camera.size),
        "focal_length": _rounded(camera.focal_length, 9),
        "principal_point": _rounded(camera.principal_point, 9),
        "distortion": _rounded(camera.distortion, 12),
    }
    if camera.port is not None:
        table["port"] = _port_table(camera.port, np.zeros(3))
    return table


def laser_table(laser: Laser) -> dict[str, Any]:
    """Give one [[laser]], with [laser.port] where there is one."""
    if isinstance(laser.sheet, Fan):
        return _fan_table(laser.sheet) | {"axis": laser.axis} | _laser_port(laser.sheet)
    return {
        "kind": "plane",
        "normal": laser.sheet.normal.tolist(),
        "distance_mm": laser.sheet.distance * 1e3,
        "axis": laser.axis,
    }


def _fan_table(fan: Fan) -> dict[str, Any]:
    return {
        "kind": "fan",
        "origin_mm": _rounded(fan.origin * 1e3, 9),
        "direction": fan.direction.tolist(),
        "tangent": fan.tangent.tolist(),
        "half_angle_deg": round(float(np.degrees(fan.half_angle)), 12),
    }


def _laser_port(fan: Fan) -> dict[str, Any]:
    return {} if fan.port is None else {"port": _port_table(fan.port, fan.origin)}


def _port_table(port: Port, origin: Vector) -> dict[str, Any]:
    if not isinstance(port, FlatPort):
        return {
            "kind": "dome",
            "radius_mm": round(port.radius * 1e3, 9),
            "thickness_mm": round(port.thickness * 1e3, 9),
            "glass_index": port.index,
            "centre_mm": _rounded((port.centre + origin) * 1e3, 9),
        }
    layers = [
        {"thickness_mm": round(layer.thickness * 1e3, 9), "index": layer.index}
        for layer in port.layers
    ]
    face = {"normal": port.normal.tolist(), "distance_mm": round(port.distance * 1e3, 9)}
    if len(layers) == 1:
        only = layers[0]
        glass = {"thickness_mm": only["thickness_mm"], "glass_index": only["index"]}
        return {"kind": "flat"} | face | glass
    return {"kind": "layers"} | face | {"layer": layers}


def water_table(water: Water) -> dict[str, Any]:
    """Give [water]."""
    if water.index is not None:
        return {"index": water.index}
    return {
        "temperature_c": water.temperature_c,
        "salinity_psu": water.salinity_psu,
        "depth_m": water.depth,
    }


def _rounded(numbers: Any, digits: int) -> list[float]:
    return [round(float(number), digits) for number in numbers]
