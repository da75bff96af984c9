"""A sphere through points of which some are wrong."""

import numpy as np

from ..errors import Degenerate
from ..types.arrays import Points
from ..types.sphere import Sphere
from .shape_fit import ShapeFit, refine_shape, require_points
from .stripe_blur import Sight

_NUM_TRIALS = 500
"""Spheres tried: one through four good points is among them, but for 1e-14, if half are good."""
_NUM_JUDGES = 2000
"""Points that judge each trial."""
_FLAT = 1e-9
"""Determinant of four points, over the cube of their extent, below which they lie in a plane."""


def fit_sphere(
    points: Points, *, sight: Sight | None = None, reach: float = 4.0, tolerance: float = 1e-9
) -> ShapeFit[Sphere]:
    """Fit a sphere to points of which up to half are wrong.

    The start is the sphere of four points with the least median distance; then least squares on
    the points within `reach` robust standard deviations. The random trials are always the same.

    Args:
        points: Points [m], all finite.
        sight: From where each was seen: the blur of the stripe is then fitted, too.
        reach: How many robust standard deviations from the sphere a point may lie.
        tolerance: Distance [m] within which a point is an inlier in any case.

    Returns:
        The fit; parameters are the centre's x, y and z, and the radius.

    Raises:
        NotEnoughData: Fewer than five points.
        InputError: A point is not finite.
        Degenerate: The points lie in a plane, or cover too little of the sphere.
        NotConverged: No sphere settles.

    References:
        Rousseeuw and Leroy, Robust Regression and Outlier Detection, 1987, chapter 5.
        Forbes, Least-squares best-fit geometric elements, NPL report DITC 140/89, 1989, section 5.
    """
    require_points(points, 5, "sphere")
    middle = points.mean(axis=0)
    centred = points - middle
    start = _least_median_sphere(centred)
    fit = refine_shape(start, centred, sight=sight, reach=reach, tolerance=tolerance)
    return fit.shifted(middle)


def _least_median_sphere(points: Points) -> Sphere:
    random = np.random.default_rng(0)
    judges = points[random.permutation(len(points))[:_NUM_JUDGES]]
    corners = points[random.integers(len(points), size=(_NUM_TRIALS, 4))]
    sides = corners[:, 1:] - corners[:, :1]
    extent = np.linalg.norm(sides, axis=2).max(axis=1)
    usable = np.abs(np.linalg.det(sides)) > _FLAT * np.maximum(extent, 1e-12) ** 3
    if not usable.any():
        raise Degenerate(
            f"The {len(points)} points lie in a plane or on a line, through which spheres of any "
            "size fit; choose points that curve."
        )
    corners, sides = corners[usable], sides[usable]
    offsets = np.linalg.solve(2 * sides, np.sum(sides**2, axis=2)[..., None])[..., 0]
    centres, radii = corners[:, 0] + offsets, np.linalg.norm(offsets, axis=1)
    medians = np.array(
        [
            np.median(np.abs(np.linalg.norm(judges - centre, axis=1) - radius))
            for centre, radius in zip(centres, radii, strict=True)
        ]
    )
    best = int(np.argmin(medians))
    return Sphere(centres[best], float(radii[best]))
