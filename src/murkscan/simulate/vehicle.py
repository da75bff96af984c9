"""How a vehicle really moves: ahead, and a little to all sides, as waves and thrusters push it."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from ..errors import InputError
from ..types.arrays import Scalars, Vector
from ..types.trajectory import Trajectory

_WAVES = 40
"""Sine waves that make up each motion."""
_STEP = 0.01
"""Time from one pose to the next [s]; between them position and attitude are interpolated."""
_LONGEST = 20_000.0
"""Longest unrest [s]: every pose of it is kept."""
_BEFORE = 2.0
"""Time before and after the recording for which the way is known [s]: logs are stamped late."""


@dataclass(frozen=True)
class Unrest:
    """How much a vehicle departs from its straight way, 1σ.

    Each motion is a sum of sine waves with random phases whose powers follow Pierson and
    Moskowitz's spectrum, f⁻⁵·exp(-5/4·(f·T)⁻⁴), with its peak at period T.

    References:
        Pierson and Moskowitz, A proposed spectral form for fully developed wind seas, Journal of
        Geophysical Research 69(24), 1964; Fossen, Handbook of Marine Craft Hydrodynamics, 2011,
        section 10.2.
    """

    speed: float = 0.0
    """Of the speed, as a share of it."""
    sway: float = 0.0
    """Across the way and the line of sight [m]."""
    heave: float = 0.0
    """Along the line of sight [m]."""
    attitude: float = 0.0
    """Of roll, pitch and yaw, each [rad]."""
    period: float = 6.0
    """Period of the strongest motion [s]."""

    def __post_init__(self) -> None:
        """Refuse what is no motion."""
        if min(self.speed, self.sway, self.heave, self.attitude) < 0 or not self.period >= 0.1:
            raise InputError(
                "motion.vehicle needs amounts that are not below 0 and a period_s of at least 0.1."
            )


def drive(
    unrest: Unrest, velocity: Vector, start: Vector, duration: float, *, seed: int
) -> Trajectory:
    """Give the true way of a vehicle's camera.

    Args:
        unrest: How it departs from its straight way.
        velocity: Its mean velocity in the world frame, whose axes are the camera's at rest [m/s].
        start: Where it is at time 0, but for sway and heave [m].
        duration: How long the recording is [s].
        seed: Which of all ways.
    """
    if unrest == Unrest(period=unrest.period):
        ends = np.array([-_BEFORE, duration + _BEFORE])
        upright = np.tile([1.0, 0.0, 0.0, 0.0], (2, 1))
        return Trajectory(ends, start + ends[:, None] * velocity, upright)
    if duration > _LONGEST:
        raise InputError(
            f"motion.frames take {duration:g} s; with motion.vehicle at most {_LONGEST:g} s."
        )
    times = np.arange(-_BEFORE, duration + _BEFORE, _STEP)
    random = np.random.default_rng([seed, 1, 0])
    waves = np.stack([_wave(times, unrest.period, random) for _ in range(6)], axis=1)
    ahead = velocity / max(float(np.linalg.norm(velocity)), 1e-12)
    sight = np.array([0.0, 0.0, 1.0])
    strayed = unrest.speed * np.cumsum(waves[:, 0]) * _STEP
    gone = times + strayed - np.interp(0.0, times, strayed)
    positions = start + gone[:, None] * velocity
    positions += unrest.sway * waves[:, 1:2] * np.cross(sight, ahead)
    positions += unrest.heave * waves[:, 2:3] * sight
    turns = Rotation.from_rotvec(unrest.attitude * waves[:, 3:6])
    return Trajectory(times, positions, turns.as_quat(scalar_first=True))


def _wave(times: Scalars, period: float, random: np.random.Generator) -> Scalars:
    """Give a random motion of variance 1, which is zero on average."""
    frequency = np.geomspace(0.5, 5.0, _WAVES) / period
    power = frequency**-5 * np.exp(-1.25 * (frequency * period) ** -4.0) * np.gradient(frequency)
    amplitude = np.sqrt(2 * power / power.sum())
    phase = random.uniform(0, 2 * math.pi, _WAVES)
    total = np.zeros(len(times))
    for a, f, p in zip(amplitude, frequency, phase, strict=True):
        total += a * np.cos(2 * math.pi * f * times + p)
    return total


@dataclass(frozen=True)
class Navigation:
    """What the vehicle's own log says of its way."""

    rate: float = 10.0
    """Poses a second [1/s]."""
    position_noise: float = 0.0
    """Error of each position along each axis, 1σ [m]."""
    attitude_noise: float = 0.0
    """Error of each attitude about each axis, 1σ [rad]."""
    latency: float = 0.0
    """How much too late poses are stamped [s]."""

    def __post_init__(self) -> None:
        """Refuse what is no log."""
        if not 0.1 <= self.rate <= 1e4:
            raise InputError(
                f"motion.navigation.rate_hz must lie between 0.1 and 10000, got {self.rate:g}."
            )
        if min(self.position_noise, self.attitude_noise) < 0:
            raise InputError("motion.navigation: noise must not be below 0.")
        if not abs(self.latency) <= _BEFORE:
            raise InputError(
                f"motion.navigation.latency_ms must lie between {-1e3 * _BEFORE:g} and "
                f"{1e3 * _BEFORE:g}, got {1e3 * self.latency:g}."
            )


def log_navigation(navigation: Navigation, truth: Trajectory, *, seed: int) -> Trajectory:
    """Give the log of a true way: sampled, with errors, and stamped late; from end to end of it."""
    count = max(int((truth.times[-1] - truth.times[0]) * navigation.rate) + 1, 2)
    times = truth.times[0] + np.arange(count) / navigation.rate
    poses = truth.at(times[times <= truth.times[-1]])
    random = np.random.default_rng([seed, 2, 0])
    shifts = random.normal(0.0, 1.0, (2, len(poses.times), 3))
    turns = Rotation.from_rotvec(navigation.attitude_noise * shifts[1])
    attitudes = poses.attitudes * turns
    return Trajectory(
        poses.times + navigation.latency,
        poses.positions + navigation.position_noise * shifts[0],
        attitudes.as_quat(scalar_first=True),
    )
