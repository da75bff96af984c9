"""The plan page: what a rig sees in a water, by the functions that `murkscan plan` calls."""

import math
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import InputError, NotEnoughData
from ..io.rig_toml import load_rig
from ..optics.beam import Light
from ..optics.medium import Medium
from ..optics.sensor import Sensor
from ..plan import (
    VISIBLE,
    Conditions,
    Forecast,
    as_if,
    attenuation_from_secchi,
    attenuation_from_visibility,
    forecast,
    judge_present,
    place_laser,
    present_place,
    visibility_from_attenuation,
)
from ..survey.plan import tell_placement
from ..types.rig import Rig
from .sandbox import Sandbox

_NUM_DEPTHS, _NUM_LINES = 36, 5
"""Fewer than the command looks at, so that a slider is followed."""
_FARTHEST, _LENGTHS = 12.0, 8.0
"""Distances shown: up to so far [m], and so many attenuation lengths one way."""
_DEFAULTS = {
    "power-mw": 30.0, "exposure-ms": 10.0, "albedo": 0.1, "spacing-mm": 5.0, "frame-rate-hz": 25.0,
    "daylight-w-m2": 0.0, "f-number": 2.0, "laser": 0.0,
}  # fmt: skip
"""What `murkscan plan` takes unless it is told."""


def tell_plan(sandbox: Sandbox, given: Mapping[str, str]) -> dict[str, Any]:
    """Say what a rig would see; `given` has the flags of `murkscan plan` by name.

    Raises:
        InputError: One of them is no number, or no water is named.
        FormatError: The rig is none.
    """
    rig, numbers = _read(sandbox, given)
    conditions, laser = _conditions(numbers), int(numbers["laser"])
    attenuation, sensor = conditions.medium.attenuation, conditions.sensor
    seen = _forecast(rig, conditions, laser)
    baseline, angle = present_place(rig, laser)
    speed = numbers["spacing-mm"] / 1e3 * numbers["frame-rate-hz"]
    return {
        "attenuation_per_m": attenuation,
        "visibility_m": visibility_from_attenuation(attenuation),
        "baseline_mm": baseline * 1e3,
        "angle_deg": math.degrees(angle),
        "fastest_mm_s": speed * 1e3,
        "smear_mm": speed * sensor.exposure * 1e3,
        **_tell(seen),
    }


def tell_best(sandbox: Sandbox, given: Mapping[str, str]) -> dict[str, Any]:
    """Say where the laser would better sit, for the range that the rig sees; as `murkscan plan`.

    Raises:
        InputError: One of the numbers is none, or no water is named.
        FormatError: The rig is none.
        NotEnoughData: Nothing would be seen.
    """
    rig, numbers = _read(sandbox, given)
    conditions, laser = _conditions(numbers), int(numbers["laser"])
    near, far = _forecast(rig, conditions, laser).reach
    longest = numbers.get("longest-baseline-mm", 2e3 * present_place(rig, laser)[0]) / 1e3
    best = place_laser(rig, conditions, near=near, far=far, longest=longest, laser=laser)
    now = judge_present(rig, conditions, near=near, far=far, laser=laser)
    return {
        "sentence": tell_placement(now, best, (near, far)),
        "near_m": near,
        "far_m": far,
        "longest_mm": longest * 1e3,
        "baseline_mm": best.baseline * 1e3,
        "angle_deg": math.degrees(best.angle),
        "share_found": best.share_found,
        "sigma_mm": best.sigma * 1e3,
    }


def _read(sandbox: Sandbox, given: Mapping[str, str]) -> tuple[Rig, Mapping[str, float]]:
    path = sandbox.existing(given.get("rig", ""))
    numbers = _DEFAULTS | {k: _number(k, v) for k, v in given.items() if k != "rig" and v}
    baseline, angle = numbers.get("baseline-mm"), numbers.get("angle-deg")
    rig = as_if(
        _load(path, path.stat().st_mtime_ns),
        None if baseline is None else baseline / 1e3,
        None if angle is None else math.radians(angle),
        int(numbers["laser"]),
    )
    return rig, numbers


def _conditions(numbers: Mapping[str, float]) -> Conditions:
    light = Light(power=numbers["power-mw"] / 1e3, ambient=numbers["daylight-w-m2"])
    sensor = Sensor(exposure=numbers["exposure-ms"] / 1e3, f_number=numbers["f-number"])
    return Conditions(Medium(_attenuation(numbers)), light, sensor, numbers["albedo"])


def _forecast(rig: Rig, conditions: Conditions, laser: int) -> Forecast:
    far = min(_LENGTHS / max(conditions.medium.attenuation, 1e-3), _FARTHEST)
    depths = np.geomspace(0.05, far, _NUM_DEPTHS)
    return forecast(rig, conditions, depths=depths, laser=laser, num_lines=_NUM_LINES)


def _tell(seen: Forecast) -> dict[str, Any]:
    try:
        reach: tuple[float, float] | None = seen.reach
        sentence = ""
    except NotEnoughData as error:
        reach, sentence = None, str(error)
    sigmas = {
        "noise": seen.sigma_along, "speckle": seen.sigma_speckle, "across": seen.sigma_across,
        "common": seen.sigma_common,
    }  # fmt: skip
    return {
        "reach_m": reach,
        "sentence": sentence,
        "visible_px": VISIBLE,
        "depths_m": seen.depths.tolist(),
        "in_view": seen.share_in_view.tolist(),
        "found": (seen.share_found * seen.share_in_view).tolist(),
        "sigma_mm": {
            name: [None if math.isnan(v) else v * 1e3 for v in seen.median(values).tolist()]
            for name, values in sigmas.items()
        },
    }


def _attenuation(numbers: Mapping[str, float]) -> float:
    if numbers.get("visibility-m"):
        return attenuation_from_visibility(numbers["visibility-m"])
    if numbers.get("secchi-m"):
        return attenuation_from_secchi(numbers["secchi-m"])
    if "attenuation-per-m" not in numbers:
        raise InputError("Say how murky the water is: how far a diver sees is enough.")
    return numbers["attenuation-per-m"]


def _number(key: str, text: str) -> float:
    try:
        number = float(text)
    except ValueError as error:
        raise InputError(f"{key} must be a number, got {text[:40]!r}.") from error
    if not math.isfinite(number) or number < 0:
        raise InputError(f"{key} must be a number of 0 or more, got {text[:40]}.")
    return number


@lru_cache(maxsize=8)
def _load(path: Path, _changed: int) -> Rig:
    rig = load_rig(path)
    if not rig.lasers:
        raise InputError(f"{path.name} has no laser; calibrate one, or write [[laser]] into it.")
    return rig
