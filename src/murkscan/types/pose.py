"""A rigid transform. Name it target_from_source: p_target = target_from_source @ p_source."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, overload

import numpy as np

from .arrays import Matrix3, Points, Quaternions, Vector
from .short_repr import ShortRepr

if TYPE_CHECKING:
    from scipy.spatial.transform import Rotation


@dataclass(frozen=True, eq=False, repr=False)
class Pose(ShortRepr):
    """A rotation, then a translation."""

    rotation: Matrix3
    """Rotation matrix from source axes to target axes."""
    translation: Vector
    """Source origin in the target frame [m]."""

    @classmethod
    def identity(cls) -> "Pose":
        """Make the transform that moves nothing."""
        return cls(np.eye(3), np.zeros(3))

    @classmethod
    def from_quaternion(cls, wxyz: Quaternions, translation: Vector) -> "Pose":
        """Make a pose from one quaternion (1 4, any length but zero) and a translation [m]."""
        from scipy.spatial.transform import Rotation

        return cls(Rotation.from_quat(wxyz[0], scalar_first=True).as_matrix(), translation)

    @property
    def attitude(self) -> "Rotation":
        """The rotation as a turn of source axes to target axes, to compute with."""
        from scipy.spatial.transform import Rotation  # a sixth of what a scan's start loads

        return Rotation.from_matrix(self.rotation)

    def as_quaternion(self) -> Quaternions:
        """Give the rotation as one unit quaternion, w x y z with w ≥ 0, shape 1 4."""
        quaternion = self.attitude.as_quat(canonical=True, scalar_first=True)
        return quaternion[None]

    @overload
    def __matmul__(self, other: "Pose") -> "Pose": ...
    @overload
    def __matmul__(self, other: Points) -> Points: ...
    def __matmul__(self, other: "Pose | Points") -> "Pose | Points":
        """Compose with a pose, or apply to points: a_from_c = a_from_b @ b_from_c."""
        if isinstance(other, Pose):
            moved = self.rotation @ other.translation + self.translation
            return Pose(self.rotation @ other.rotation, moved)
        return other @ self.rotation.T + self.translation

    def turn(self, attitudes: Quaternions) -> Quaternions:
        """Give attitudes in a that are given in b: a_from_c of b_from_c, w x y z, one a row."""
        from scipy.spatial.transform import Rotation

        turns = Rotation.from_quat(attitudes, scalar_first=True)
        return (self.attitude * turns).as_quat(scalar_first=True)

    def inverse(self) -> "Pose":
        """Swap the frames: b_from_a of a_from_b."""
        return Pose(self.rotation.T, -self.rotation.T @ self.translation)
