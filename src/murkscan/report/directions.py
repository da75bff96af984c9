"""The surface's own directions: along the motion, across it, and towards the scanner."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from ..types.arrays import Matrix3, Points, Vector
from ..types.laser import Axis
from ..types.trajectory import Trajectory

_STILL = 1e-9
"""Way of the camera below which it has no direction [m]."""


@dataclass(frozen=True, eq=False)
class SurfaceDirections:
    """Three unit directions at right angles, in the world frame.

    ::

                 towards the scanner
                      |   / across (along the stripe)
                      |  /
        the surface   | /
        --------------+------------> along the motion
    """

    along: Vector
    """Along the motion."""
    across: Vector
    """Across it, along the stripe."""
    towards: Vector
    """Towards the scanner."""

    @classmethod
    def from_trajectory(cls, trajectory: Trajectory, axis: Axis) -> "SurfaceDirections":
        """Take the motion from the way's two ends, and the stripe from the pose half-way.

        Args:
            trajectory: world_from_camera. Where it ends where it began, the direction in which it
                stretches farthest counts; where it stands still, the laser's axis.
            axis: The camera axis along which the laser sits.
        """
        middle = trajectory.quaternions[len(trajectory.times) // 2]
        world_from_camera = Rotation.from_quat(middle, scalar_first=True).as_matrix()
        x, y = world_from_camera[:, 0], world_from_camera[:, 1]
        stripe, beside = (x, y) if axis == "y" else (y, x)
        along = _heading(trajectory.positions)
        along = beside if along is None else along
        across = stripe - along * (stripe @ along)
        if np.linalg.norm(across) < 0.1:  # moved along its own stripe
            across = beside - along * (beside @ along)
        across /= np.linalg.norm(across)
        towards = np.cross(along, across)
        return cls(along, across, -towards if towards @ world_from_camera[:, 2] > 0 else towards)

    def as_matrix(self) -> Matrix3:
        """Give the rotation from the world to these directions."""
        return np.stack([self.along, self.across, self.towards])


def _heading(positions: Points) -> Vector | None:
    """Tell where a way leads; None where it stands still."""
    spread = positions - positions.mean(axis=0)
    reach = np.linalg.norm(spread, axis=1).max()
    way = positions[-1] - positions[0]
    if np.linalg.norm(way) < reach:
        way = np.linalg.svd(spread[:: max(1, len(spread) // 1000)], full_matrices=False)[2][0]
    return way / np.linalg.norm(way) if reach > _STILL else None
