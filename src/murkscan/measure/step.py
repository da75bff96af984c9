"""The height of a step between two parallel planes."""

import math

import numpy as np
from jaxtyping import Int

from ..geometry.correlated_errors import covariance_of_fit
from ..geometry.shape_fit import ShapeFit
from ..types.arrays import Points, Scalars, Vector
from ..types.measurement import Measurement
from ..types.plane import Plane, span_plane
from ..types.quantity import Quantity
from .fits import trust_plane
from .remarks import remark_on_fit
from .sample import Sample
from .trust import FitUncertainty

_MOST_SHIFTED = 1000
"""Points of each plane for which the rig's errors are traced."""


def measure_step(first: Sample, second: Sample) -> Measurement:
    """Fit two parallel planes to two parts of a scan, and give their distance.

    The distance is positive where the second stands nearer to the camera. The angle between planes
    fitted one by one tells whether they are parallel at all; a difference by more than its
    uncertainty makes the step's height depend on where it is taken, which is midway.

    Args:
        first: Points of one plane, without those at its edges.
        second: Points of the other.

    Raises:
        NotEnoughData: A part has fewer than four points.
        Degenerate: The points of a part lie on one line.
    """
    parts = [trust_plane(sample) for sample in (first, second)]
    chosen = [np.flatnonzero(fit.inliers) for fit, _ in parts]
    points = np.concatenate(
        [s.cloud.points[i] for s, i in zip((first, second), chosen, strict=True)]
    )
    normal = parts[0][0].shape.normal + parts[1][0].shape.normal
    normal /= np.linalg.norm(normal)
    is_second = np.repeat([0.0, 1.0], [len(i) for i in chosen])
    heights, design = _both_planes(points, normal, is_second)
    solution, *_ = np.linalg.lstsq(design, heights, rcond=None)
    profile, line = (
        np.concatenate([getattr(s, name)[i] for s, i in zip((first, second), chosen, strict=True)])
        for name in ("profile", "line")
    )
    trust = covariance_of_fit(design, heights - design @ solution, profile, line)
    common = _common_step(first, second, chosen, normal)
    step = Quantity(
        "step", float(solution[1]), "m", math.sqrt(trust.matrix[1, 1]), common, trust.degrees
    )
    details = {"points": len(points), "normal": normal.tolist(), "degrees": trust.degrees}
    samples = zip(parts, (first, second), strict=True)
    remarks = [text for (fit, _), s in samples for text in remark_on_fit("plane", fit, s)]
    places = {"first": parts[0][0].middle, "second": parts[1][0].middle}
    return Measurement(
        "step", (step, _angle(parts)), details, tuple(dict.fromkeys(remarks)), places
    )


def _both_planes(points: Points, normal: Vector, is_second: Scalars) -> tuple[Scalars, np.ndarray]:
    """Give heights along a normal, and how they change with place, step and two tilts."""
    centred = points - points.mean(axis=0)
    sides = centred @ span_plane(normal).T
    design = np.column_stack([np.ones(len(points)), is_second, sides])
    return centred @ normal, design


def _common_step(
    first: Sample, second: Sample, chosen: list[Int[np.ndarray, " _"]], normal: Vector
) -> float | None:
    """Give how the rig's errors change the step [m]."""
    if first.shifts is None or second.shifts is None:
        return None
    some = [inside[:: max(len(inside) // _MOST_SHIFTED, 1)] for inside in chosen]
    shifts = np.concatenate([first.shifts(some[0]), second.shifts(some[1])])
    points = np.concatenate([first.cloud.points[some[0]], second.cloud.points[some[1]]])
    _, design = _both_planes(points, normal, np.repeat([0.0, 1.0], [len(i) for i in some]))
    modes, *_ = np.linalg.lstsq(design, np.einsum("i,nim->nm", normal, shifts), rcond=None)
    return float(np.linalg.norm(modes[1]))


def _angle(parts: list[tuple[ShapeFit[Plane], FitUncertainty]]) -> Quantity:
    """Give the angle between the planes fitted one by one, with how well it is known."""
    (one, trust_one), (other, trust_other) = parts
    angle = math.acos(min(float(one.shape.normal @ other.shape.normal), 1.0))
    variances = [
        float(np.trace(trust.independent[:2, :2])) / 2 for trust in (trust_one, trust_other)
    ]
    degrees = min(trust_one.degrees, trust_other.degrees)
    return Quantity("angle_between", angle, "rad", math.sqrt(sum(variances)), None, degrees)
