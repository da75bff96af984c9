"""How far apart two surfaces lie where both were seen."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ..errors import Degenerate, NotEnoughData
from ..types.arrays import Directions, Points, Scalars
from ..types.cloud import PointCloud
from ..types.pose import Pose
from .alignment_fit import AlignmentFit
from .surface_points import SurfacePoints

_REACH = 5.0
"""Spacings of the thinned surfaces up to which one is looked for before or behind the other."""


@dataclass(frozen=True, eq=False)
class Disagreement:
    """The places where two surfaces are the same; one a row."""

    points: Points
    """Where they are [m]."""
    normals: Directions
    """Of both surfaces there."""
    distances: Scalars
    """How far the first lies in front of the second [m]."""
    share: float
    """Share of the smaller surface that they cover."""

    @property
    def mean(self) -> float:
        """Mean distance, with its sign [m]."""
        return float(self.distances.mean())

    @property
    def rms(self) -> float:
        """Root mean square distance [m]."""
        return float(np.sqrt(np.mean(self.distances**2)))

    @property
    def within_95(self) -> float:
        """Distance within which they lie at 95 % of the places [m]."""
        return float(np.quantile(np.abs(self.distances), 0.95))


def find_disagreement(first: PointCloud, second: PointCloud) -> Disagreement | None:
    """Compare two clouds as they lie, without their noise; None where they share no surface.

    Args:
        first: Points [m].
        second: Others, in the same frame.
    """
    try:
        one, other = SurfacePoints.from_cloud(first), SurfacePoints.from_cloud(second)
        spacing = max(one.spacing, other.spacing)
        one = SurfacePoints.from_cloud(first, spacing=spacing)
        other = SurfacePoints.from_cloud(second, spacing=spacing)
        reach = _REACH * spacing
        fit = AlignmentFit.at(Pose.identity(), one, other, cKDTree(other.points), reach)
    except (Degenerate, NotEnoughData):
        return None
    share = len(fit.residuals) / min(len(one), len(other))
    return Disagreement(fit.points, fit.jacobian[:, 3:], fit.residuals, min(share, 1.0))
