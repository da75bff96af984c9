"""Plane, sphere and cylinder through a part of a scan."""

import math
from collections.abc import Mapping, Sequence

import numpy as np

from ..errors import NotEnoughData
from ..geometry.cylinder_fit import fit_cylinder
from ..geometry.plane_fit import fit_plane
from ..geometry.shape import AnyShape
from ..geometry.shape_fit import ShapeFit, refine_shape, require_points
from ..geometry.sphere_fit import fit_sphere
from ..types.arrays import Vector
from ..types.measurement import Measurement
from ..types.plane import Plane, span_plane
from ..types.quantity import Quantity
from ..types.sphere import Sphere
from .remarks import remark_on_fit
from .sample import Sample
from .settle import fit_settled
from .trust import FitUncertainty, LinearMap, trust_fit

_FEWEST_PROFILES = 3
"""Profiles below which a fit has nothing across the sheet of light to agree with."""


def measure_plane(sample: Sample) -> Measurement:
    """Fit a plane: its unit normal, and the distance of the world's origin from it.

    The normal is turned to the camera.

    Raises:
        NotEnoughData: Fewer than four points, or three profiles.
        Degenerate: The points lie on one line.
    """
    fit, trust = trust_plane(sample)
    plane, sides = fit.shape, span_plane(fit.shape.normal)
    how = np.zeros((4, 3))
    how[1:, :2] = sides.T
    how[0] = [*(-(sides @ fit.middle)), 1.0]
    values = dict(zip("xyz", plane.normal.tolist(), strict=True))
    named = {"distance": plane.distance} | {f"normal_{axis}": n for axis, n in values.items()}
    return _tell("plane", fit, trust, sample, named, ("m", "", "", ""), how, {"middle": fit.middle})


def trust_plane(sample: Sample) -> tuple[ShapeFit[Plane], FitUncertainty]:
    """Fit a plane whose normal points to the camera, and find how far to trust it.

    Raises:
        NotEnoughData: Fewer than four points, or three profiles.
        Degenerate: The points lie on one line.
    """
    points = sample.cloud.points
    require_points(points, 4, "plane")
    _require_profiles(sample, "plane")
    middle = points.mean(axis=0)
    start = fit_plane(points - middle).plane
    if np.sum(sample.cloud.normals @ start.normal) < 0:
        start = Plane(-start.normal, -start.distance)
    fit = refine_shape(start, points - middle).shifted(middle)
    return trust_fit(fit, sample)


def measure_sphere(sample: Sample) -> Measurement:
    """Fit a sphere: radius, diameter and centre.

    Raises:
        NotEnoughData: Fewer than five points, or three profiles.
        Degenerate: The points lie in a plane, or cover too little of the sphere.
        NotConverged: No sphere settles.
    """
    fit, trust = trust_sphere(sample)
    sphere = fit.shape
    values = {"radius": sphere.radius, "diameter": 2 * sphere.radius}
    values |= dict(zip(("x", "y", "z"), sphere.centre.tolist(), strict=True))
    how = np.zeros((5, fit.slopes.shape[1]))
    how[0, 3], how[1, 3] = 1, 2
    how[2:, :3] = np.eye(3)
    return _tell("sphere", fit, trust, sample, values, ("m",) * 5, how, {"centre": sphere.centre})


def trust_sphere(sample: Sample) -> tuple[ShapeFit[Sphere], FitUncertainty]:
    """Fit a sphere, and find how far to trust its centre's x, y and z, and its radius.

    Raises:
        NotEnoughData: Fewer than five points, or three profiles.
        Degenerate: The points lie in a plane, or cover too little of the sphere.
        NotConverged: No sphere settles.
    """
    _require_profiles(sample, "sphere")
    fit, settled = fit_settled(lambda s: fit_sphere(s.cloud.points, sight=s.sight), sample)
    return trust_fit(fit, settled)


def measure_cylinder(sample: Sample) -> Measurement:
    """Fit a cylinder: radius, diameter, a point of its axis and the axis' direction.

    Of the point that coordinate in whose direction the axis runs most is set, to the middle of the
    points, and has no uncertainty; the other two say where the axis passes there.

    Raises:
        NotEnoughData: Fewer than six points, or three profiles.
        Degenerate: The points do not curve, or cover too little of the cylinder.
        NotConverged: No cylinder settles.
    """
    _require_profiles(sample, "cylinder")
    normals = sample.cloud.normals.astype(float)
    fit, settled = fit_settled(
        lambda s: fit_cylinder(s.cloud.points, normals, sight=s.sight), sample
    )
    fit, trust = trust_fit(fit, settled)
    cylinder, sides = fit.shape, span_plane(fit.shape.axis)
    values = {"radius": cylinder.radius, "diameter": 2 * cylinder.radius}
    values |= dict(zip(("x", "y", "z"), cylinder.point.tolist(), strict=True))
    values |= dict(zip(("axis_x", "axis_y", "axis_z"), cylinder.axis.tolist(), strict=True))
    how = np.zeros((8, fit.slopes.shape[1]))
    how[0, 4], how[1, 4] = 1, 2
    how[2:5, :2] = how[5:, 2:4] = sides.T
    # The set coordinate stays: what would move it moves the point along the axis instead.
    most = int(np.argmax(np.abs(cylinder.axis)))
    how[2:5] -= np.outer(cylinder.axis / cylinder.axis[most], how[2 + most])
    how[2 + most] = 0.0
    units = ("m",) * 5 + ("",) * 3
    places = {"on the axis": cylinder.point}
    return _tell("cylinder", fit, trust, sample, values, units, how, places)


def _require_profiles(sample: Sample, what: str) -> None:
    """Refuse points that all lie in the laser's sheet, through which any shape fits too well."""
    count = len(np.unique(sample.profile))
    if count < _FEWEST_PROFILES:
        raise NotEnoughData(
            f"The {len(sample)} points lie in {count} profile{'s' if count > 1 else ''}, which "
            f"show the laser's sheet rather than a {what}; choose a part of the scan with "
            f"{_FEWEST_PROFILES} profiles or more."
        )


def _tell(
    kind: str,
    fit: ShapeFit[AnyShape],
    trust: FitUncertainty,
    sample: Sample,
    values: dict[str, float],
    units: Sequence[str],
    how: LinearMap,
    places: Mapping[str, Vector],
) -> Measurement:
    """Say what a fit gave, and how well its points agree."""
    spread = fit.rms / math.sqrt(2 * trust.degrees)
    rms = Quantity("rms_residual", fit.rms, "m", spread, 0.0, trust.degrees)
    details = {
        "points": len(fit.inliers),
        "inliers": int(fit.inliers.sum()),
        "independent_patches": round(trust.degrees + fit.slopes.shape[1]),
    }
    quantities = (*trust.as_quantities(values, units, how), rms)
    return Measurement(kind, quantities, details, remark_on_fit(kind, fit, sample), places)
