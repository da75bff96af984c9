"""Normal equations of an adjustment, from which the boards' poses have been taken out.

Each photo has a pose of its own, so the poses' part of the matrix is a row of 6 x 6 blocks, and
what is left has the size of the rig's parameters, whatever the number of photos.

References:
    Triggs, McLauchlan, Hartley and Fitzgibbon, Bundle adjustment: a modern synthesis, 2000,
    section 6.1.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from ...types.arrays import Scalars
from .residuals import Linearised
from .weights import Weights

_TINY = 1e-12
"""Share of a pose block's largest entry that keeps one solvable whose corners all were let go."""


@dataclass(frozen=True, eq=False)
class NormalEquations:
    """Sums over the rows of each photo, of weighted residuals."""

    rig: Float[np.ndarray, "p k k"]
    """Σ by_rigᵀ by_rig."""
    rig_slope: Float[np.ndarray, "p k"]
    """Σ by_rigᵀ residual."""
    pose: Float[np.ndarray, "p 6 6"]
    pose_slope: Float[np.ndarray, "p 6"]
    cross: Float[np.ndarray, "p 6 k"]
    """Σ by_poseᵀ by_rig."""

    @classmethod
    def of(cls, found: Linearised, weights: Weights, num_photos: int) -> "NormalEquations":
        """Sum up the weighed rows of each photo."""
        order = np.argsort(found.photo, kind="stable")
        ends = np.cumsum(np.bincount(found.photo, minlength=num_photos))[:-1]
        by_rig, by_pose, residuals = (
            np.split(weights.weigh(rows)[order], ends)
            for rows in (found.by_rig, found.by_pose, found.residuals)
        )
        return cls(
            np.stack([a.T @ a for a in by_rig]),
            np.stack([a.T @ r for a, r in zip(by_rig, residuals, strict=True)]),
            np.stack([b.T @ b for b in by_pose]),
            np.stack([b.T @ r for b, r in zip(by_pose, residuals, strict=True)]),
            np.stack([b.T @ a for a, b in zip(by_rig, by_pose, strict=True)]),
        )

    def reduce(self) -> tuple[Float[np.ndarray, "p k k"], Float[np.ndarray, "p k"]]:
        """Give what each photo adds to the matrix and the slope of the rig's parameters alone."""
        through = np.linalg.solve(_solvable(self.pose), self.cross).transpose(0, 2, 1)
        matrices = self.rig - through @ self.cross
        slopes = self.rig_slope - np.einsum("pks,ps->pk", through, self.pose_slope)
        return matrices, slopes

    def damp(self, share: float) -> "NormalEquations":
        """Raise the diagonals by a share, so that steps become shorter."""
        raised = [m * (1 + share * np.eye(m.shape[1])) for m in (self.rig, self.pose)]
        return NormalEquations(raised[0], self.rig_slope, raised[1], self.pose_slope, self.cross)

    def solve(
        self, prior: Float[np.ndarray, "k k"], pull: Scalars
    ) -> tuple[Scalars, Float[np.ndarray, "p 6"]]:
        """Give the step of the rig's parameters and that of each pose.

        Args:
            prior: Inverse covariance of the parameters known beforehand.
            pull: The same times how far they are from their value.
        """
        matrices, slopes = self.reduce()
        matrix, slope = matrices.sum(axis=0) + prior, slopes.sum(axis=0) + pull
        size = np.sqrt(np.maximum(np.diag(matrix), np.finfo(float).tiny))
        scaled = matrix / np.outer(size, size)
        step = -np.linalg.lstsq(scaled, slope / size, rcond=1e-15)[0] / size
        rest = self.pose_slope + np.einsum("psk,k->ps", self.cross, step)
        return step, -np.linalg.solve(_solvable(self.pose), rest[:, :, None])[:, :, 0]


def _solvable(blocks: Float[np.ndarray, "p 6 6"]) -> Float[np.ndarray, "p 6 6"]:
    largest = np.maximum(blocks.max(axis=(1, 2)), 1.0)
    return blocks + _TINY * largest[:, None, None] * np.eye(6)
