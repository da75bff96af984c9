"""Whether the covariance in a rig file still belongs to the rig beside it."""

import hashlib
import json
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from ..types.rig import Rig
from .rig_as_tables import camera_table, laser_table, water_table


def fingerprint(rig: Rig, names: Sequence[str]) -> str:
    """Give a short word that changes when the camera, or a laser among the names, changes."""
    numbers = {int(name[6:].split("]")[0]) for name in names if name.startswith("laser[")}
    lasers = [laser_table(laser) for i, laser in enumerate(rig.lasers) if i in numbers]
    text = json.dumps([camera_table(rig.camera), sorted(numbers), lasers], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:12]


def water_of(rig: Rig) -> dict[str, Any] | str:
    """Give the water that a covariance holds in, as the rig file writes it."""
    return "air" if rig.water is None else water_table(rig.water)


def drop_stale(rig: Rig, *, of: str | None, water: dict[str, Any] | str | None) -> Rig:
    """Drop what the covariance no longer says rightly.

    All of it where the camera or a laser was edited since; the index of the water where the rig
    went to other water. A file that does not say what its covariance is of is believed.
    """
    covariance = rig.covariance
    if of is not None and of != fingerprint(rig, covariance.names):
        covariance = covariance.select([])
    if water is not None and water != water_of(rig):
        covariance = covariance.without("water.")
    return replace(rig, covariance=covariance)
