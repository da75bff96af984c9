"""Whether the covariance in a rig file still belongs to the rig beside it."""

import hashlib
import json
from dataclasses import replace
from typing import Any

from ..types.rig import Rig
from .rig_as_tables import camera_table, laser_table, water_table


def fingerprints(rig: Rig) -> dict[str, str]:
    """Give a short word for each part of a rig, which changes when that part is edited."""
    camera = camera_table(rig.camera)
    parts = {"port": camera.pop("port", None), "camera": camera}
    parts |= {f"laser[{i}]": laser_table(laser) for i, laser in enumerate(rig.lasers)}
    return {name: _word(table) for name, table in parts.items()}


def water_of(rig: Rig) -> dict[str, Any] | str:
    """Give the water that a covariance holds in, as the rig file writes it."""
    return "air" if rig.water is None else water_table(rig.water)


def drop_stale(rig: Rig, *, of: dict[str, str] | None, water: dict[str, Any] | str | None) -> Rig:
    """Drop what the covariance no longer says rightly.

    All of it where the camera was edited since; the port and the lasers behind it where the port
    was; a laser where it was; the water's index where the rig went to other water. A file that
    does not say what its covariance is of is believed.
    """
    covariance = rig.covariance
    if of is not None:
        now = fingerprints(rig)
        edited = {part for part, word in of.items() if now.get(part) != word}
        if "camera" in edited:
            covariance = covariance.select([])
        if "port" in edited:
            edited |= {"camera.port", "laser[", "water."}
        for part in edited:
            covariance = covariance.without(part)
    if water is not None and water != water_of(rig):
        covariance = covariance.without("water.")
    return replace(rig, covariance=covariance)


def _word(table: dict[str, Any] | None) -> str:
    return hashlib.sha256(json.dumps(table, sort_keys=True).encode()).hexdigest()[:12]
