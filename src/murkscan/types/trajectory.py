"""Where the camera was at which time."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from ..errors import InputError
from .arrays import Mask, Matrix3, Points, Quaternions, Scalars, Vector
from .pose import Pose
from .short_repr import ShortRepr

if TYPE_CHECKING:
    from scipy.spatial.transform import Rotation


@dataclass(frozen=True, eq=False, repr=False)
class Trajectory(ShortRepr):
    """Poses world_from_camera at increasing times, at least one; between them it interpolates."""

    times: Scalars
    """Times [s], strictly increasing."""
    positions: Points
    """Optical centre in the world frame [m]."""
    quaternions: Quaternions
    """Rotation from camera axes to world axes, w x y z."""
    errors: Float[np.ndarray, "n 6 m"] | None = None
    """Independent errors of the whole way, each of one standard deviation: what it shifts the
    optical centre by [m], and turns the camera by about it [rad], along the world's axes. The
    covariance of two poses is the product of their errors. None where nothing is stated."""

    def __post_init__(self) -> None:
        """Refuse times that do not increase."""
        if len(self.times) == 0 or not np.all(np.diff(self.times) > 0):
            raise InputError(
                f"A trajectory needs strictly increasing times, got {len(self.times)} of them."
            )

    @classmethod
    def concatenate(cls, parts: Sequence["Trajectory"]) -> "Trajectory":
        """Put trajectories one after another, at least one; the errors of each are its own.

        Raises:
            InputError: Their times do not increase.
        """
        columns = ("times", "positions", "quaternions")
        joined = [np.concatenate([getattr(part, name) for part in parts]) for name in columns]
        counts = [part.num_errors for part in parts]
        errors = np.zeros((sum(len(part.times) for part in parts), 6, sum(counts)))
        row = column = 0
        for part, count in zip(parts, counts, strict=True):
            if part.errors is not None:
                errors[row : row + len(part.times), :, column : column + count] = part.errors
            row, column = row + len(part.times), column + count
        times, positions, quaternions = joined
        return cls(times, positions, quaternions, errors if any(counts) else None)

    @classmethod
    def concatenate_joint(cls, parts: Sequence["Trajectory"]) -> "Trajectory":
        """Put trajectories one after another whose error k is the same one in all of them.

        Raises:
            InputError: Their times do not increase.
        """
        columns = ("times", "positions", "quaternions", "errors")
        return cls(*(np.concatenate([getattr(part, name) for part in parts]) for name in columns))

    @property
    def num_errors(self) -> int:
        """Count its independent errors."""
        return 0 if self.errors is None else self.errors.shape[2]

    def at(self, times: Scalars) -> "Trajectory":
        """Interpolate: positions linearly, attitudes by slerp; times [s] strictly increasing.

        Raises:
            InputError: A time lies outside the trajectory, or they do not increase.

        References:
            Shoemake, Animating rotation with quaternion curves, SIGGRAPH 1985.
        """
        if len(times) and (times[0] < self.times[0] or times[-1] > self.times[-1]):
            raise InputError(
                f"Poses are asked for from {times[0]:.3f} to {times[-1]:.3f} s but the log runs "
                f"from {self.times[0]:.3f} to {self.times[-1]:.3f} s."
            )
        positions = np.stack([np.interp(times, self.times, p) for p in self.positions.T], axis=1)
        rotations = self.attitudes
        if len(self.times) > 1:
            from scipy.spatial.transform import Slerp

            rotations = Slerp(self.times, rotations)(times)
        errors = self.errors
        if errors is not None and len(self.times) > 1:
            before = np.clip(np.searchsorted(self.times, times) - 1, 0, len(self.times) - 2)
            share = (times - self.times[before]) / (self.times[before + 1] - self.times[before])
            share = share[:, None, None]
            errors = (1 - share) * errors[before] + share * errors[before + 1]
        return Trajectory(times, positions, rotations.as_quat(scalar_first=True), errors)

    @property
    def attitudes(self) -> "Rotation":
        """The quaternions as turns of camera axes to world axes, to compute with."""
        from scipy.spatial.transform import Rotation  # a sixth of what a scan's start loads

        return Rotation.from_quat(self.quaternions, scalar_first=True)

    def has(self, times: Scalars) -> Mask:
        """Tell which times [s] are among its own: frames whose pose is known, not interpolated."""
        return np.isin(times, self.times)

    def transform(self, points: Points, times: Scalars) -> Points:
        """Carry camera points [m] to the world frame; point i was seen at times[i] [s].

        Raises:
            InputError: A time lies outside the trajectory.
        """
        if len(times) == 0:
            return points
        rotations, positions = self._poses_of(times)
        return np.einsum("nij,nj->ni", rotations, points) + positions

    def to_camera(self, points: Points, times: Scalars) -> Points:
        """Carry points of the world [m] to the camera; the inverse of `transform`.

        Raises:
            InputError: A time lies outside the trajectory.
        """
        if len(times) == 0:
            return points
        rotations, positions = self._poses_of(times)
        return np.einsum("nji,nj->ni", rotations, points - positions)

    def _poses_of(self, times: Scalars) -> tuple[Float[np.ndarray, "n 3 3"], Points]:
        """Give the rotation and the position at each time; points of a profile share theirs."""
        moments, which = np.unique(times, return_inverse=True)
        poses = self.at(moments)
        rotations = poses.attitudes.as_matrix()
        return rotations[which], poses.positions[which]

    def line_of_sight(self) -> Vector:
        """Compute the mean direction in which the camera looked, in the world; unit length."""
        return np.asarray(self.attitudes.mean().apply(np.array([0.0, 0.0, 1.0])))

    def mean_attitude(self) -> Matrix3:
        """Compute the mean rotation from camera axes to world axes."""
        return self.attitudes.mean().as_matrix()

    def follow_mount(self, source_from_camera: Pose) -> "Trajectory":
        """Give world_from_camera where this is world_from_source: a vehicle with a mount."""
        rotations = self.attitudes
        arms = rotations.apply(source_from_camera.translation)
        return Trajectory(
            self.times,
            self.positions + arms,
            (rotations * source_from_camera.attitude).as_quat(scalar_first=True),
            None if self.errors is None else _at_arms(self.errors, arms),
        )

    def shifts(self, points: Points, times: Scalars) -> Float[np.ndarray, "n 3 m"]:
        """Compute how each of the errors moves points.

        Args:
            points: In the world [m].
            times: When each was seen [s].

        Returns:
            Shifts along the world's axes [m]; no columns where the trajectory states no errors.
        """
        if self.errors is None:
            return np.zeros((len(points), 3, 0))
        moments, which = np.unique(times, return_inverse=True)
        poses = self.at(moments)
        assert poses.errors is not None
        return _at_arms(poses.errors[which], points - poses.positions[which])[:, :3]

    def carry(self, target_from_world: Pose) -> "Trajectory":
        """Give target_from_camera where this is world_from_camera."""
        positions = target_from_world @ self.positions
        errors = self.errors
        if errors is not None:
            turn = np.kron(np.eye(2), target_from_world.rotation)
            errors = np.einsum("ij,njm->nim", turn, errors)
        return Trajectory(self.times, positions, target_from_world.turn(self.quaternions), errors)


def _at_arms(errors: Float[np.ndarray, "n 6 m"], arms: Points) -> Float[np.ndarray, "n 6 m"]:
    """Carry errors from the origin to the ends of arms [m] that turn with it."""
    moved = errors.copy()
    moved[:, :3] += np.cross(errors[:, 3:], arms[:, :, None], axis=1)
    return moved
