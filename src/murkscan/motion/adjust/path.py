"""The way of a vehicle in one pass, as numbers that an adjustment can change."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from ..._kernels.spline_poses import evaluate_poses
from ...types.arrays import Indices, Points, Scalars
from ...types.trajectory import Trajectory
from .spline import Knots, Matrices, Weights, evaluate, rotation_rate

WIDTH = 6
"""Unknowns a control value: three of the position [m], three of the turn [rad]."""


@dataclass(frozen=True, eq=False)
class Poses:
    """Where a path is at some times, and how that changes with its unknowns."""

    times: Scalars
    positions: Points
    rotations: Matrices
    """world_from_vehicle."""
    turned_by: Matrices
    """Turn of the vehicle about the world's axes for a change of the spline of turns."""
    first: Indices
    """Number of the first of the four control values that count."""
    weights: Weights
    """Their weights."""


@dataclass(frozen=True, eq=False)
class Path:
    """world_from_vehicle over a pass: R(t) = Exp(φ(t))·R₀(t), with splines φ, R₀ and position.

    R₀ is the log's own attitude, made smooth; φ is what the adjustment turns it by.
    """

    knots: Knots
    positions: Float[np.ndarray, "k 3"]
    """Control values of the position [m]."""
    turns: Float[np.ndarray, "k 3"]
    """Control values of φ [rad], about the world's axes."""
    reference: Rotation
    """Control rotations of R₀."""

    @property
    def num_unknowns(self) -> int:
        """Count the numbers that an adjustment may change."""
        return WIDTH * self.knots.num_controls

    def at(self, times: Scalars) -> Poses:
        """Give the poses at some times within the knots [s]."""
        first, along = self.knots.locate(times)
        weights, positions, rotations, turned_by = evaluate_poses(
            first, along, self.positions, self.turns, *self._reference_steps
        )
        return Poses(times, positions, rotations, turned_by, first, weights)

    @cached_property
    def _reference_steps(self) -> tuple[Float[np.ndarray, "k 4"], Float[np.ndarray, "j 3"]]:
        """Give R₀'s control rotations as quaternions, and the turn from each to the next [rad]."""
        steps = (self.reference[:-1].inv() * self.reference[1:]).as_rotvec()
        return self.reference.as_quat(scalar_first=True), steps

    def velocity(self, times: Scalars, *, derivative: int = 1) -> Points:
        """Give the velocity along the world's axes [m/s], or the acceleration [m/s²]."""
        return evaluate(self.knots, self.positions, times, derivative=derivative)

    def rates(self, times: Scalars) -> Points:
        """Give the turn rate about the world's axes [rad/s]."""
        turns = evaluate(self.knots, self.turns, times)
        change = evaluate(self.knots, self.turns, times, derivative=1)
        own = np.einsum("nij,nj->ni", left_jacobian(turns), change)
        reference = rotation_rate(self.knots, self.reference, times)
        return own + Rotation.from_rotvec(turns).apply(reference)

    def moved(self, step: Float[np.ndarray, " u"]) -> "Path":
        """Change the unknowns: for each control value its position, then its turn."""
        change = step.reshape(-1, WIDTH)
        return replace(
            self, positions=self.positions + change[:, :3], turns=self.turns + change[:, 3:]
        )

    def as_trajectory(
        self, times: Scalars, errors: Float[np.ndarray, "k 6 m"] | None = None
    ) -> Trajectory:
        """Give world_from_vehicle at some times [s].

        Args:
            times: Within the knots, strictly increasing [s].
            errors: Independent errors of the control values, each of one standard deviation.
        """
        poses = self.at(times)
        rotations = Rotation.from_matrix(poses.rotations)
        quaternions = rotations.as_quat(scalar_first=True)
        if errors is None:
            return Trajectory(times, poses.positions, quaternions)
        near = errors[poses.first[:, None] + np.arange(4)]
        moves = np.einsum("nj,njdm->ndm", poses.weights, near)
        moves[:, 3:] = poses.turned_by @ moves[:, 3:]
        return Trajectory(times, poses.positions, quaternions, moves)


def left_jacobian(turns: Points) -> Matrices:
    """Give how Exp(φ) turns with a change of φ, about the target's axes.

    References:
        Solà, Deray, Atchuthan, A micro Lie theory for state estimation in robotics, 2018,
        equation (145).
    """
    angle = np.maximum(np.linalg.norm(turns, axis=1), 1e-6)
    first, second = (1 - np.cos(angle)) / angle**2, (angle - np.sin(angle)) / angle**3
    skew = skew_matrices(turns)
    return np.eye(3) + first[:, None, None] * skew + second[:, None, None] * (skew @ skew)


def skew_matrices(vectors: Points) -> Matrices:
    """Give the matrices by which one multiplies to take the cross product with each vector."""
    skew = np.zeros((len(vectors), 3, 3))
    skew[:, 2, 1], skew[:, 0, 2], skew[:, 1, 0] = vectors.T
    return skew - skew.transpose(0, 2, 1)
