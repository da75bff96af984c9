"""[navigation] of rig.toml: how good the vehicle's log is."""

import math
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat

from ..types.navigation import NavigationAccuracy

_Noise = Annotated[FiniteFloat, Field(gt=0)] | None
_Amount = Annotated[FiniteFloat, Field(ge=0)]
_DEGREE = math.pi / 180


class NavigationTable(BaseModel):
    """The table as users write it: one standard deviation each; what is absent is not used."""

    model_config = ConfigDict(extra="forbid")

    velocity_noise_mm_s: _Noise = None
    velocity_bias_mm_s: _Amount = 0
    speed_percent: _Noise = None
    attitude_noise_deg: _Noise = None
    attitude_bias_deg: _Amount = 0
    heading_noise_deg: _Noise = None
    heading_drift_deg_min: _Amount = 0
    rate_noise_deg_s: _Noise = None
    depth_noise_mm: _Noise = None
    position_noise_mm: _Noise = None
    clock_offset_s: _Amount = 0
    clock_drift_ppm: _Amount = 0

    def as_accuracy(self) -> NavigationAccuracy:
        """Compute the accuracy in metres, seconds and radians."""
        values: dict[str, Any] = {}
        for key, (name, unit) in _UNITS.items():
            value = getattr(self, key)
            values[name] = None if value is None else value * unit
        return NavigationAccuracy(**values)


_UNITS = {
    "velocity_noise_mm_s": ("velocity_noise", 1e-3),
    "velocity_bias_mm_s": ("velocity_bias", 1e-3),
    "speed_percent": ("speed", 1e-2),
    "attitude_noise_deg": ("attitude_noise", _DEGREE),
    "attitude_bias_deg": ("attitude_bias", _DEGREE),
    "heading_noise_deg": ("heading_noise", _DEGREE),
    "heading_drift_deg_min": ("heading_drift", _DEGREE / 60),
    "rate_noise_deg_s": ("rate_noise", _DEGREE),
    "depth_noise_mm": ("depth_noise", 1e-3),
    "position_noise_mm": ("position_noise", 1e-3),
    "clock_offset_s": ("clock_offset", 1.0),
    "clock_drift_ppm": ("clock_drift", 1e-6),
}
"""Key of the table: field of `NavigationAccuracy`, and its unit."""


def navigation_table(accuracy: NavigationAccuracy) -> dict[str, float]:
    """Compute [navigation] from an accuracy; what is not stated is left out."""
    table = {}
    for key, (name, unit) in _UNITS.items():
        value = getattr(accuracy, name)
        if value:
            table[key] = round(value / unit, 9)
    return table
