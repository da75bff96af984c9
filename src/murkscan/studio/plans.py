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
    attenuation_from_secchi,
    attenuation_from_visibility,
    forecast,
    visibility_from_attenuation,
)
from ..plan.placement import present_place
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
    path = sandbox.existing(given.get("rig", ""))
    rig = _load(path, path.stat().st_mtime_ns)
    numbers = _DEFAULTS | {k: _number(k, v) for k, v in given.items() if k not in ("rig",) and v}
    attenuation, laser = _attenuation(numbers), int(numbers["laser"])
    light = Light(power=numbers["power-mw"] / 1e3, ambient=numbers["daylight-w-m2"])
    sensor = Sensor(exposure=numbers["exposure-ms"] / 1e3, f_number=numbers["f-number"])
    conditions = Conditions(Medium(attenuation), light, sensor, numbers["albedo"])
    far = min(_LENGTHS / max(attenuation, 1e-3), _FARTHEST)
    seen = forecast(
        rig, conditions, depths=np.geomspace(0.05, far, _NUM_DEPTHS), laser=laser,
        num_lines=_NUM_LINES,
    )  # fmt: skip
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
