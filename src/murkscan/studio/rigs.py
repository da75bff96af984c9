"""The rig page: what is calibrated, how well, and what to do next."""

import math
from typing import Any

from ..errors import FormatError
from ..io.rig_toml import parse_rig, read_tables
from ..plan.placement import present_place
from ..types.rig import Rig
from .sandbox import Sandbox

_WINDOWS = {"FlatPort": "flat", "DomePort": "a dome"}


def tell_rig(sandbox: Sandbox, name: str) -> dict[str, Any]:
    """Say what a rig file holds: a row for each part, with its verdict where it was calibrated.

    Raises:
        InputError: It does not lie in the folder.
        FormatError: It is no TOML.
    """
    path = sandbox.existing(name)
    tables = read_tables(path)
    try:
        rig, fault = parse_rig(tables, name=name), ""
    except FormatError as error:
        rig, fault = None, str(error)
    records = tables.get("calibration", {})
    steps = [_step("camera", records.get("camera"), is_there="camera" in tables)]
    port = tables.get("camera", {}).get("port") if isinstance(tables.get("camera"), dict) else None
    steps.append(_step("port", records.get("port"), is_there=port is not None))
    lasers = tables.get("laser", []) or [None]
    for number, laser in enumerate(lasers):
        together, record = _of_laser(records.get("laser", {}), number)
        steps.append(
            _step(f"laser {number}", record, is_there=laser is not None, folder=f"laser_{together}")
        )
    steps.append(_step("mount", records.get("mount"), is_there="mount" in tables))
    for step in steps:
        page = path.parent / "calibrate" / step.pop("folder") / "index.html"
        step["page"] = sandbox.name(page) if page.exists() else ""
    return {
        "name": name,
        "fault": fault,
        "steps": steps,
        "facts": [] if rig is None else _facts(rig),
    }


def _of_laser(records: dict[str, Any], number: int) -> tuple[str, Any]:
    """Find the record of a laser, which may have been calibrated together with others."""
    for key, record in records.items():
        if str(number) in key.split(","):
            return key.replace(",", "_"), record
    return str(number), None


def _step(step: str, record: Any, *, is_there: bool, folder: str = "") -> dict[str, Any]:
    record = record if isinstance(record, dict) else {}
    return {
        "step": step,
        "folder": folder or step,
        "is_there": is_there,
        "is_calibrated": bool(record),
        "is_good": str(record.get("verdict", "")).startswith("Good"),
        "is_usable": not str(record.get("verdict", "")).startswith("Not usable"),
        "verdict": str(record.get("verdict", "")),
        "date": str(record.get("date", "")),
        "board": str(record.get("board", "")),
        "square_mm": record.get("square_mm"),
        "views": record.get("views"),
        "photos": record.get("photos"),
        "rms_px": record.get("rms_px"),
        "errors": list(record.get("errors", [])),
        "unused": dict(record.get("unused", {})),
    }


def _facts(rig: Rig) -> list[tuple[str, str]]:
    width, height = rig.camera.size
    focal = rig.camera.focal_length[0]
    facts = [
        ("picture", f"{width} × {height} px"),
        ("focal length", f"{focal:.1f} px, {math.degrees(2 * math.atan(width / 2 / focal)):.0f}° "
         "wide in air"),
        ("window", _WINDOWS.get(type(rig.camera.port).__name__, "none")),
        ("water", "none: in air" if rig.water is None else "as the rig file says"),
    ]  # fmt: skip
    for number, laser in enumerate(rig.lasers):
        baseline, angle = present_place(rig, number)
        place = f"b = {baseline * 1e3:.1f} mm, θ = {math.degrees(angle):.2f}°"
        facts.append((f"laser {number}", f"{type(laser.sheet).__name__}, {place}"))
    known = "known, so that lengths get whole intervals" if rig.covariance.names else (
        "not stated: intervals lack the calibration's part"
    )  # fmt: skip
    return [*facts, ("uncertainty", known)]
