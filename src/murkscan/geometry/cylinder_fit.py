"""A cylinder through points of which some are wrong."""

import numpy as np

from ..errors import Degenerate
from ..types.arrays import Directions, Points
from ..types.cylinder import Cylinder
from .shape_fit import ShapeFit, refine_shape, require_points
from .stripe_blur import Sight

_NUM_TRIALS = 500
"""Cylinders tried: one through two good points is among them if half are good."""
_NUM_JUDGES = 2000
"""Points that judge each trial."""
_LEAST_TURN = 0.05
"""Sine of the angle between two normals below which they do not tell the axis."""


def fit_cylinder(
    points: Points,
    normals: Directions,
    *,
    sight: Sight | None = None,
    reach: float = 4.0,
    tolerance: float = 1e-9,
) -> ShapeFit[Cylinder]:
    """Fit an endless cylinder to points of which up to half are wrong.

    The start is the cylinder of two points and their normals with the least median distance; then
    least squares on the points within `reach` robust standard deviations. The random trials are
    always the same.

    Args:
        points: Points [m], all finite.
        normals: Surface normal at each; zero where there is none.
        sight: From where each was seen: the blur of the stripe is then fitted, too.
        reach: How many robust standard deviations from the cylinder a point may lie.
        tolerance: Distance [m] within which a point is an inlier in any case.

    Returns:
        The fit; `shape.point` is the place of the axis nearest to the middle of the points.
        Parameters are two shifts and two tilts of the axis, and the radius.

    Raises:
        NotEnoughData: Fewer than six points.
        InputError: A point is not finite.
        Degenerate: All normals are parallel, or the points cover too little of the cylinder.
        NotConverged: No cylinder settles.

    References:
        Schnabel, Wahl, Klein, Efficient RANSAC for point-cloud shape detection, Computer Graphics
        Forum 26(2), 2007, section 4.1 (the start).
        Forbes, Least-squares best-fit geometric elements, NPL report DITC 140/89, 1989, section 6.
    """
    require_points(points, 6, "cylinder")
    middle = points.mean(axis=0)
    centred = points - middle
    start = _least_median_cylinder(centred, normals)
    fit = refine_shape(start, centred, sight=sight, reach=reach, tolerance=tolerance)
    start = _nearest_point(fit.shape)
    fit = refine_shape(start, centred, sight=sight, reach=reach, tolerance=tolerance)
    return fit.shifted(middle)


def _least_median_cylinder(points: Points, normals: Directions) -> Cylinder:
    random = np.random.default_rng(0)
    judges = points[random.permutation(len(points))[:_NUM_JUDGES]]
    known = np.flatnonzero(np.any(normals != 0, axis=1))
    if len(known) == 0:
        raise Degenerate("None of the points has a normal, which a cylinder's axis is found from.")
    first, second = known[random.integers(len(known), size=(2, _NUM_TRIALS))]
    axes = np.cross(normals[first], normals[second])
    turn = np.linalg.norm(axes, axis=1)
    usable = turn > _LEAST_TURN
    if not usable.any():
        raise Degenerate(
            f"The normals of the {len(points)} points are all parallel, as on a plane; choose "
            "points that curve."
        )
    trials = [
        _through_pair(points[[i, j]], normals[[i, j]], axis)
        for i, j, axis in zip(
            first[usable], second[usable], axes[usable] / turn[usable, None], strict=True
        )
    ]
    medians = [float(np.median(np.abs(trial.distance_to(judges)))) for trial in trials]
    return trials[int(np.argmin(medians))]


def _through_pair(points: Points, normals: Directions, axis: np.ndarray) -> Cylinder:
    """Put the axis where both normals, seen along it, meet."""
    apart = points[1] - points[0]
    apart = apart - (apart @ axis) * axis
    (along, _), *_ = np.linalg.lstsq(np.stack([normals[0], -normals[1]], axis=1), apart, rcond=None)
    point = points[0] + along * normals[0]
    across = points - point
    across = across - (across @ axis)[:, None] * axis
    return Cylinder(point, axis, float(np.linalg.norm(across, axis=1).mean()))


def _nearest_point(cylinder: Cylinder) -> Cylinder:
    """Name the axis by its point nearest to the origin."""
    point = cylinder.point - (cylinder.point @ cylinder.axis) * cylinder.axis
    return Cylinder(point, cylinder.axis, cylinder.radius)
