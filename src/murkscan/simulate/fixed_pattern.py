"""What makes one pixel of a sensor unlike another, in every picture alike."""

from dataclasses import dataclass

import numpy as np

from ..optics.sensor import Picture, Sensor

_HOT = 0.1, 1.0
"""Charge of a hot pixel in the dark, as a share of the full well, from the least to the most."""


@dataclass(frozen=True, eq=False)
class FixedPattern:
    """A sensor's own picture.

    References:
        EMVA Standard 1288, release 4.0, section 4 (photo response and dark signal non-uniformity).
    """

    response: Picture
    """Electrons that each pixel gives for those of a mean one."""
    dark: Picture
    """Electrons that each pixel gives in the dark."""


def draw_fixed_pattern(sensor: Sensor, size: tuple[int, int], *, seed: int) -> FixedPattern:
    """Draw the pattern of a sensor of that width and height [px]."""
    width, height = size
    random = np.random.default_rng([seed, 4, 0])
    response = 1 + sensor.response * random.standard_normal((height, width))
    dark = sensor.full_well * random.uniform(*_HOT, (height, width))
    dark[random.random((height, width)) >= sensor.hot_pixels] = 0.0
    return FixedPattern(np.maximum(response, 0.0).astype(np.float32), dark.astype(np.float32))
