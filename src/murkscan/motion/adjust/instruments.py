"""What each instrument of a vehicle reads of its path, and how that changes with the path."""

import abc
from dataclasses import dataclass
from typing import ClassVar, final

import numpy as np
from jaxtyping import Float

from ...types.arrays import Scalars
from .path import Path, Poses, skew_matrices
from .unknowns import slopes_of_turn


class Instrument(abc.ABC):
    """What one kind of instrument reads of a path. Subclasses are final."""

    errors: ClassVar[tuple[str, ...]] = ()
    """Names of its own errors; see `unknowns`."""

    @abc.abstractmethod
    def predict(self, path: Path, poses: Poses) -> Float[np.ndarray, "n m"]:
        """Compute what it would read without errors, at the times of the poses."""

    @abc.abstractmethod
    def slopes(self, path: Path, poses: Poses) -> Float[np.ndarray, "n 4 m 6"]:
        """Compute how that changes with the four control values that count."""

    def error_slopes(self, times: Scalars) -> list[Float[np.ndarray, "n m"]]:
        """Compute how readings change with each of `errors`."""
        return []

    def subtract(
        self, first: Float[np.ndarray, "n m"], second: Float[np.ndarray, "n m"]
    ) -> Float[np.ndarray, "n m"]:
        """Compute the difference of two readings."""
        return first - second


def _heading_and_pitch(poses: Poses) -> tuple[Scalars, Scalars]:
    forward = poses.rotations[:, :, 0]
    return np.arctan2(forward[:, 1], forward[:, 0]), np.arcsin(np.clip(-forward[:, 2], -1, 1))


def _euler_slopes(poses: Poses) -> Float[np.ndarray, "n 3 3"]:
    """Give how roll, pitch and heading change as the vehicle turns about the world's axes.

    References:
        Fossen, Handbook of Marine Craft Hydrodynamics and Motion Control, 2011, equation (2.26).
    """
    heading, pitch = _heading_and_pitch(poses)
    cos, sin, zero, one = (
        np.cos(heading),
        np.sin(heading),
        np.zeros_like(pitch),
        np.ones_like(pitch),
    )
    level, steep = np.maximum(np.cos(pitch), 0.05), np.sin(pitch)
    rows = [[cos / level, sin / level, zero], [-sin, cos, zero]]
    rows.append([cos * steep / level, sin * steep / level, one])
    return np.moveaxis(np.array(rows), 2, 0)


@final
@dataclass(frozen=True)
class Tilt(Instrument):
    """Roll and pitch, each with a bias."""

    errors: ClassVar[tuple[str, ...]] = ("roll_bias", "pitch_bias")

    def predict(self, path: Path, poses: Poses) -> Float[np.ndarray, "n m"]:
        """Compute what it would read; see `Instrument.predict`."""
        _, pitch = _heading_and_pitch(poses)
        roll = np.arctan2(poses.rotations[:, 2, 1], poses.rotations[:, 2, 2])
        return np.stack([roll, pitch], axis=1)

    def slopes(self, path: Path, poses: Poses) -> Float[np.ndarray, "n 4 m 6"]:
        """Compute its slopes; see `Instrument.slopes`."""
        return slopes_of_turn(poses, _euler_slopes(poses)[:, :2])

    def error_slopes(self, times: Scalars) -> list[Float[np.ndarray, "n m"]]:
        """Compute the slopes of its errors; see `Instrument.error_slopes`."""
        return [np.tile(axis, (len(times), 1)) for axis in np.eye(2)]

    def subtract(
        self, first: Float[np.ndarray, "n m"], second: Float[np.ndarray, "n m"]
    ) -> Float[np.ndarray, "n m"]:
        """Compute the difference, within half a turn; see `Instrument.subtract`."""
        return _wrap(first - second)


@final
@dataclass(frozen=True)
class Heading(Instrument):
    """Heading, which is off and drifts."""

    middle: float
    """Time from which its drift counts [s]."""
    errors: ClassVar[tuple[str, ...]] = ("heading_offset", "heading_drift")

    def predict(self, path: Path, poses: Poses) -> Float[np.ndarray, "n m"]:
        """Compute what it would read; see `Instrument.predict`."""
        return _heading_and_pitch(poses)[0][:, None]

    def slopes(self, path: Path, poses: Poses) -> Float[np.ndarray, "n 4 m 6"]:
        """Compute its slopes; see `Instrument.slopes`."""
        return slopes_of_turn(poses, _euler_slopes(poses)[:, 2:])

    def error_slopes(self, times: Scalars) -> list[Float[np.ndarray, "n m"]]:
        """Compute the slopes of its errors; see `Instrument.error_slopes`."""
        return [np.ones((len(times), 1)), (times - self.middle)[:, None]]

    def subtract(
        self, first: Float[np.ndarray, "n m"], second: Float[np.ndarray, "n m"]
    ) -> Float[np.ndarray, "n m"]:
        """Compute the difference, within half a turn; see `Instrument.subtract`."""
        return _wrap(first - second)


@final
@dataclass(frozen=True)
class Velocity(Instrument):
    """Velocity along the vehicle's axes."""

    errors: ClassVar[tuple[str, ...]] = ("velocity_bias_x", "velocity_bias_y", "velocity_bias_z")

    def predict(self, path: Path, poses: Poses) -> Float[np.ndarray, "n m"]:
        """Compute what it would read; see `Instrument.predict`."""
        return np.einsum("nji,nj->ni", poses.rotations, path.velocity(poses.times))

    def slopes(self, path: Path, poses: Poses) -> Float[np.ndarray, "n 4 m 6"]:
        """Compute its slopes; see `Instrument.slopes`."""
        back = poses.rotations.transpose(0, 2, 1)
        slopes = slopes_of_turn(poses, back @ skew_matrices(path.velocity(poses.times)))
        _, weights = path.knots.weights(poses.times, derivative=1)
        slopes[..., :3] = weights[:, :, None, None] * back[:, None]
        return slopes

    def error_slopes(self, times: Scalars) -> list[Float[np.ndarray, "n m"]]:
        """Compute the slopes of its errors; see `Instrument.error_slopes`."""
        return [np.tile(axis, (len(times), 1)) for axis in np.eye(3)]


@final
@dataclass(frozen=True)
class Rates(Instrument):
    """Turn rates about the vehicle's axes."""

    errors: ClassVar[tuple[str, ...]] = ("rate_bias_x", "rate_bias_y", "rate_bias_z")

    def predict(self, path: Path, poses: Poses) -> Float[np.ndarray, "n m"]:
        """Compute what it would read; see `Instrument.predict`."""
        return np.einsum("nji,nj->ni", poses.rotations, path.rates(poses.times))

    def slopes(self, path: Path, poses: Poses) -> Float[np.ndarray, "n 4 m 6"]:
        """Compute its slopes; see `Instrument.slopes`."""
        # A turn δ of the whole way changes the rate by δ' along the world's axes, and nothing
        # along the vehicle's: Rᵀ(ω + δ' + δ×ω) - Rᵀ(δ×ω) = Rᵀ(ω + δ').
        back = poses.rotations.transpose(0, 2, 1)
        _, weights = path.knots.weights(poses.times, derivative=1)
        slopes = np.zeros((len(back), 4, 3, 6))
        slopes[..., 3:] = weights[:, :, None, None] * (back @ poses.turned_by)[:, None]
        return slopes

    def error_slopes(self, times: Scalars) -> list[Float[np.ndarray, "n m"]]:
        """Compute the slopes of its errors; see `Instrument.error_slopes`."""
        return [np.tile(axis, (len(times), 1)) for axis in np.eye(3)]


@final
@dataclass(frozen=True)
class Place(Instrument):
    """Some coordinates of the position."""

    axes: tuple[int, ...]
    """Which coordinates."""

    def predict(self, path: Path, poses: Poses) -> Float[np.ndarray, "n m"]:
        """Compute what it would read; see `Instrument.predict`."""
        return poses.positions[:, list(self.axes)]

    def slopes(self, path: Path, poses: Poses) -> Float[np.ndarray, "n 4 m 6"]:
        """Compute its slopes; see `Instrument.slopes`."""
        slopes = np.zeros((len(poses.times), 4, len(self.axes), 6))
        slopes[..., :3] = poses.weights[:, :, None, None] * np.eye(3)[list(self.axes)]
        return slopes


def _wrap(angles: Float[np.ndarray, "n m"]) -> Float[np.ndarray, "n m"]:
    return (angles + np.pi) % (2 * np.pi) - np.pi
