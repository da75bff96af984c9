"""A rig by what is known of it without a calibration: picture, laser, window, water."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from ..errors import InputError
from ..io.rig_toml import put_tables, read_tables

_WIDEST = 170.0
"""Widest view that a camera without distortion is made of [degrees]."""


@dataclass(frozen=True)
class Described:
    """What is said of a rig, in the units of its file; None: nothing."""

    size: tuple[int, int] | None = None
    """Width and height of the pictures [px]."""
    view_deg: float | None = None
    """How wide the camera sees in air."""
    baseline_mm: float | None = None
    angle_deg: float | None = None
    axis: Literal["x", "y"] = "y"
    window_mm: float | None = None
    """From the optical centre to the inner face of a flat window."""
    dome_radius_mm: float | None = None
    """Inner radius of a dome around the optical centre."""
    glass_mm: float | None = None
    glass_index: float = 1.49
    temperature_c: float | None = None
    salinity_psu: float | None = None
    wavelength_nm: float = 532.0


def describe_rig(path: Path, given: Described) -> None:
    """Write what is known of a rig into its file; what was calibrated is not replaced.

    Args:
        path: The rig file; made where it is missing.
        given: What is known.

    Raises:
        InputError: Nothing is said, a new file would have no camera, or what is said stands there
            by a calibration.
        FormatError: The file is no rig file, or a value cannot be.
    """
    tables = _tables(given)
    if not tables:
        raise InputError("Say something of the rig: its picture, laser, window or water.")
    known = read_tables(path) if path.exists() else {"wavelength_nm": given.wavelength_nm}
    if "camera" not in known and "size" not in tables.get("camera", {}):
        raise InputError(
            f"{path} has no camera yet: give --size-px and --view-deg, or calibrate it first."
        )
    _refuse_calibrated(path, known, tables)
    put_tables(path, {} if path.exists() else known, tables)


def _refuse_calibrated(path: Path, known: dict[str, Any], tables: dict[str, Any]) -> None:
    records = known.get("calibration", {})
    said = {
        "camera": "size" in tables.get("camera", {}),
        "port": "port" in tables.get("camera", {}),
        "laser": "laser" in tables,
    }
    for word, is_said in said.items():
        if is_said and records.get(word):
            raise InputError(
                f"The {word} of {path} was calibrated, and is not replaced by a description; give "
                "another file with --rig."
            )


def _tables(given: Described) -> dict[str, Any]:
    tables: dict[str, Any] = {}
    camera = _camera(given) | _port(given)
    if camera:
        tables["camera"] = camera
    if given.baseline_mm is not None:
        tables["laser"] = {
            "kind": "baseline_angle",
            "baseline_mm": given.baseline_mm,
            "angle_deg": given.angle_deg,
            "axis": given.axis,
        }
    if given.temperature_c is not None:
        tables["water"] = {
            "temperature_c": given.temperature_c,
            "salinity_psu": given.salinity_psu,
        }
    return tables


def _camera(given: Described) -> dict[str, Any]:
    """Make a camera without distortion whose axis meets the middle of the picture."""
    if given.size is None or given.view_deg is None:
        return {}
    if given.view_deg > _WIDEST:
        raise InputError(f"A view of {given.view_deg:g} degrees needs a calibrated camera.")
    width, height = given.size
    focal = round(width / 2 / math.tan(math.radians(given.view_deg) / 2), 3)
    return {
        "size": [width, height],
        "focal_length": [focal, focal],
        "principal_point": [(width - 1) / 2, (height - 1) / 2],
        "distortion": [0.0] * 5,
    }


def _port(given: Described) -> dict[str, Any]:
    glass = {"thickness_mm": given.glass_mm, "glass_index": given.glass_index}
    if given.window_mm is not None:
        face = {"kind": "flat", "normal": [0.0, 0.0, 1.0], "distance_mm": given.window_mm}
        return {"port": face | glass}
    if given.dome_radius_mm is not None:
        return {"port": {"kind": "dome", "radius_mm": given.dome_radius_mm} | glass
                | {"centre_mm": [0.0, 0.0, 0.0]}}  # fmt: skip
    return {}
