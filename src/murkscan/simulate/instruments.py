"""What a vehicle's instruments measure of its way, as they err."""

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from ..errors import InputError
from ..types.navigation import Navigation, NavigationAccuracy, Readings
from ..types.trajectory import Trajectory

Kind = Literal["dvl", "ahrs"]
_STEP = 0.02
"""Time on both sides of a moment over which its velocity is taken [s]."""


@dataclass(frozen=True)
class Instruments:
    """Attitude and depth, and velocities with a DVL; how well, 1σ."""

    kind: Kind
    rate: float
    """Readings a second [1/s]."""
    latency: float
    """How much too late readings are stamped [s]."""
    accuracy: NavigationAccuracy

    def __post_init__(self) -> None:
        """Refuse instruments of which nothing is stated."""
        needed = {"attitude_noise_deg": self.accuracy.attitude_noise,
                  "depth_noise_mm": self.accuracy.depth_noise}  # fmt: skip
        if self.kind == "dvl":
            needed["velocity_noise_mm_s"] = self.accuracy.velocity_noise
        for key, value in needed.items():
            if not value:
                raise InputError(
                    f"motion.navigation.{key} must be above 0 for instruments of the kind "
                    f"{self.kind}."
                )


def measure_way(instruments: Instruments, truth: Trajectory, *, seed: int) -> Navigation:
    """Measure a true way: noise from reading to reading, biases and a drift that stay.

    Args:
        instruments: How they err.
        truth: world_from_vehicle; the world is north, east, down.
        seed: Which of all errors.
    """
    accuracy, random = instruments.accuracy, np.random.default_rng([seed, 3, 0])
    times = np.arange(truth.times[0] + _STEP, truth.times[-1] - _STEP, 1 / instruments.rate)
    poses = truth.at(times)
    turns = poses.attitudes
    attitude = turns.as_euler("ZYX")[:, ::-1]
    attitude = attitude + (accuracy.attitude_noise or 0.0) * random.normal(size=attitude.shape)
    attitude[:, :2] += accuracy.attitude_bias * random.normal(size=2)
    attitude[:, 2] += accuracy.heading_drift * random.normal() * (times - times[0])
    depth = poses.positions[:, 2:]
    depth = depth + (accuracy.depth_noise or 0.0) * random.normal(size=depth.shape)
    stamps = times + instruments.latency
    navigation = Navigation(
        accuracy, attitude=Readings(stamps, attitude), depth=Readings(stamps, depth)
    )
    if instruments.kind == "ahrs":
        return navigation
    steps = truth.at(times + _STEP).positions - truth.at(times - _STEP).positions
    velocity = turns.inv().apply(steps / (2 * _STEP))
    velocity += accuracy.velocity_bias * random.normal(size=3)
    velocity += (accuracy.velocity_noise or 0.0) * random.normal(size=velocity.shape)
    return replace(navigation, velocity=Readings(stamps, velocity))
