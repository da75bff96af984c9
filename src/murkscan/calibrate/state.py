"""The rig as it was before a step of its calibration, so that a step may be done again.

A step adjusts the camera along, within its covariance. Done again on what it left behind, it would
count its photos twice; so it starts from what it kept in its own record.
"""

import copy
from collections.abc import Sequence
from typing import Any

from ..io.rig_toml import parse_rig


def tables_before(tables: dict[str, Any], step: Sequence[str], *, name: str) -> dict[str, Any]:
    """Give the tables of a rig file as they were before a step; as they are if that is new.

    What has been edited since stays edited: the camera, or a laser, is put back only where it is
    the one that the step left behind.

    Args:
        tables: The tables as they are.
        step: Where in [calibration] the step's record is.
        name: What an error calls the rig file.
    """
    record: Any = tables.get("calibration", {})
    for word in step:
        record = record.get(word, {})
    before = record.get("before")
    if before is None:
        return tables
    covariance = parse_rig(tables, name=name).covariance
    if not covariance.names:
        return tables
    restored = copy.deepcopy(tables)
    port = restored["camera"].get("port")
    restored["camera"] = copy.deepcopy(before["camera"])
    if port is not None:
        restored["camera"]["port"] = port
    if "mount" in before and any(word.startswith("mount.") for word in covariance.names):
        restored["mount"] = copy.deepcopy(before["mount"])
    for number, laser in before.get("laser", {}).items():
        is_as_left = any(word.startswith(f"laser[{number}]") for word in covariance.names)
        if is_as_left and int(number) < len(restored.get("laser", [])):
            restored["laser"][int(number)] = copy.deepcopy(laser)
    restored["calibration"].pop("covariance", None)
    if "covariance" in before:
        restored["calibration"]["covariance"] = copy.deepcopy(before["covariance"])
    return restored


def snapshot(tables: dict[str, Any], *, lasers: Sequence[int] = ()) -> dict[str, Any]:
    """Give what `tables_before` needs, to be kept in a step's record.

    Args:
        tables: The tables of the rig file before the step.
        lasers: Numbers of the lasers that the step calibrates.
    """
    covariance = tables.get("calibration", {}).get("covariance")
    kept = {"camera": tables["camera"]}
    if covariance is not None:
        kept["covariance"] = covariance
    known = [] if covariance is None else covariance["parameters"]
    moved = {
        str(number): table
        for number, table in enumerate(tables.get("laser", []))
        if number in lasers or any(name.startswith(f"laser[{number}]") for name in known)
    }
    if moved:
        kept["laser"] = moved
    if any(name.startswith("mount.") for name in known):
        kept["mount"] = tables["mount"]
    return copy.deepcopy(kept)
