"""A plane through points of which some are wrong."""

from dataclasses import dataclass

import numpy as np

from ..errors import Degenerate, NotEnoughData
from ..types.arrays import Mask, Points, Scalars
from ..types.plane import Plane

_NUM_TRIALS = 300
"""Planes tried: one through three good points is among them, but for 1e-17, if half are good."""
_NUM_JUDGES = 2000
"""Points that judge each trial: enough for a median to 2 %, few enough to be quick."""
_GAUSSIAN = 1.4826
"""Standard deviation of Gaussian noise as a multiple of its median absolute value."""
_NUM_REFITS = 20
"""Refits at most; the set of inliers settles in three to six."""
_THIN = 1e-6
"""Width of the points over their length below which they are a line, not a plane."""


@dataclass(frozen=True, eq=False)
class PlaneFit:
    """A plane, and how well each point agrees."""

    plane: Plane
    """The plane of the inliers, least squares."""
    residuals: Scalars
    """Signed distance of every point from the plane [m], NaN where the point is NaN."""
    inliers: Mask
    """Which points the plane was fitted to."""

    @property
    def rms(self) -> float:
        """Root mean square distance of the inliers [m]."""
        return float(np.sqrt(np.mean(self.residuals[self.inliers] ** 2)))


def fit_plane(points: Points, *, reach: float = 4.0, tolerance: float = 1e-9) -> PlaneFit:
    """Fit a plane to points of which up to half are wrong.

    The start is the plane of three points with the least median distance; then least squares on
    the points within `reach` robust standard deviations, until these no longer change. The random
    trials are always the same ones, so equal points give an equal plane.

    Args:
        points: Points [m]; rows with NaN are left out.
        reach: How many robust standard deviations from the plane a point may lie.
        tolerance: Distance [m] within which a point is an inlier in any case, so that points
            without noise do not reject each other.

    Raises:
        NotEnoughData: Fewer than three points.
        Degenerate: The points lie on one line.

    References:
        Rousseeuw and Leroy, Robust Regression and Outlier Detection, 1987, chapter 5.
    """
    is_finite = np.isfinite(points).all(axis=1)
    finite = points[is_finite]
    if len(finite) < 3:
        raise NotEnoughData(f"A plane needs at least 3 points, got {len(finite)}.")
    plane, spread = _least_median_plane(finite)
    kept = np.zeros(len(finite), dtype=bool)
    for _ in range(_NUM_REFITS):
        now = np.abs(plane.distance_to(finite)) <= max(reach * spread, tolerance)
        if np.array_equal(now, kept):
            break
        kept = now
        plane = _least_squares_plane(finite[kept])
        spread = _GAUSSIAN * float(np.median(np.abs(plane.distance_to(finite))))
    inliers = is_finite.copy()
    inliers[is_finite] = kept
    return PlaneFit(plane, plane.distance_to(points), inliers)


def _least_median_plane(points: Points) -> tuple[Plane, float]:
    """Give the plane of least median distance, and the robust standard deviation about it [m]."""
    random = np.random.default_rng(0)
    judges = points
    if len(points) > _NUM_JUDGES:
        judges = points[random.choice(len(points), _NUM_JUDGES, replace=False)]
    a, b, c = points[random.integers(len(points), size=(3, _NUM_TRIALS))]
    normals = np.cross(b - a, c - a)
    lengths = np.linalg.norm(normals, axis=1)
    sizes = np.linalg.norm(b - a, axis=1) * np.linalg.norm(c - a, axis=1)
    usable = lengths > _THIN * np.maximum(sizes, np.finfo(float).tiny)
    if not usable.any():
        plane = _least_squares_plane(points)
        return plane, _GAUSSIAN * float(np.median(np.abs(plane.distance_to(points))))
    normals, a = normals[usable] / lengths[usable, None], a[usable]
    distances = normals @ judges.T - np.sum(a * normals, axis=1)[:, None]
    medians = np.median(np.abs(distances, out=distances), axis=1, overwrite_input=True)
    best = int(np.argmin(medians))
    return Plane.through(a[best], normals[best]), _GAUSSIAN * float(medians[best])


def _least_squares_plane(points: Points) -> Plane:
    """Give the plane of least squared distances; Degenerate where the points lie on one line."""
    centre = points.mean(axis=0)
    _, extents, axes = np.linalg.svd(points - centre, full_matrices=False)
    if len(points) < 3 or extents[1] <= _THIN * extents[0]:
        raise Degenerate(
            f"The {len(points)} points that agree lie on one line, through which any plane fits. "
            "Take points on both sides of it."
        )
    return Plane.through(centre, axes[2])
