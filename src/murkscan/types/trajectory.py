"""Where the camera was at which time."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

from ..errors import InputError
from .arrays import Mask, Points, Quaternions, Scalars
from .pose import Pose


@dataclass(frozen=True, eq=False)
class Trajectory:
    """Poses world_from_camera at increasing times, at least one; between them it interpolates."""

    times: Scalars
    """Times [s], strictly increasing."""
    positions: Points
    """Optical centre in the world frame [m]."""
    quaternions: Quaternions
    """Rotation from camera axes to world axes, w x y z."""

    def __post_init__(self) -> None:
        """Refuse times that do not increase."""
        if len(self.times) == 0 or not np.all(np.diff(self.times) > 0):
            raise InputError(
                f"A trajectory needs strictly increasing times, got {len(self.times)} of them."
            )

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
        rotations = Rotation.from_quat(self.quaternions, scalar_first=True)
        if len(self.times) > 1:
            rotations = Slerp(self.times, rotations)(times)
        return Trajectory(times, positions, rotations.as_quat(scalar_first=True))

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
        moments, which = np.unique(times, return_inverse=True)
        poses = self.at(moments)
        rotations = Rotation.from_quat(poses.quaternions, scalar_first=True).as_matrix()
        return np.einsum("nij,nj->ni", rotations[which], points) + poses.positions[which]

    def follow_mount(self, source_from_camera: Pose) -> "Trajectory":
        """Give world_from_camera where this is world_from_source: a vehicle with a mount."""
        rotations = Rotation.from_quat(self.quaternions, scalar_first=True)
        return Trajectory(
            self.times,
            self.positions + rotations.apply(source_from_camera.translation),
            (rotations * Rotation.from_matrix(source_from_camera.rotation)).as_quat(
                scalar_first=True
            ),
        )

    def carry(self, target_from_world: Pose) -> "Trajectory":
        """Give target_from_camera where this is world_from_camera."""
        positions = target_from_world @ self.positions
        return Trajectory(self.times, positions, target_from_world.turn(self.quaternions))
