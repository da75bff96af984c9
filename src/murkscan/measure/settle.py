"""Passes of a merged cloud, laid on one another by a shape that all of them saw."""

from collections.abc import Callable
from dataclasses import replace
from typing import TypeVar

import numpy as np
from jaxtyping import Float

from ..geometry.correlated_errors import covariance_of_fit
from ..geometry.shape import AnyShape
from ..geometry.shape_fit import ShapeFit
from ..types.arrays import Indices
from .sample import Sample, Shifts

_MOST = 2000
"""Points by which the passes are laid: how alignments move points varies slowly over a shape."""
_PART = 20_000
"""Points that are moved at once."""
_ROUNDS = 3
"""Estimates: of passes that lie far apart the first one sees too few points that agree."""

Shape = TypeVar("Shape", bound=AnyShape)
Errors = Float[np.ndarray, " modes"]
"""The alignments' errors, in standard deviations."""
MovesOf = Callable[[Indices], Shifts]


def fit_settled(
    fit: Callable[[Sample], ShapeFit[Shape]], sample: Sample
) -> tuple[ShapeFit[Shape], Sample]:
    """Fit a shape, and its passes' alignments with it.

    Alignment tells from the whole overlap how the passes lie, and how well: along a wall it leaves
    open what a ball before the wall shows. Each alignment's errors are parameters beside those of
    the shape, known beforehand as well as alignment says; so more passes never tell less.

    Args:
        fit: Fits the shape to a sample's points.
        sample: The points.

    Returns:
        The fit, and the points where it has laid them, whose `shifts` are what is still open.

    References:
        Björck, Numerical Methods for Least Squares Problems, 1996, section 2.7 (least squares with
        what is known beforehand).
    """
    found, settled = fit(sample), sample
    if sample.shifts is None or sample.num_alignments == 0:
        return found, sample
    errors = np.zeros(sample.num_alignments)
    for _ in range(_ROUNDS):
        errors, still_open = _estimate(found, settled, sample.shifts, errors)
        settled = _lay(sample, sample.shifts, errors, still_open)
        found = fit(settled)
    return found, settled


def _estimate(
    fit: ShapeFit[AnyShape], sample: Sample, shifts: MovesOf, before: Errors
) -> tuple[Errors, Float[np.ndarray, "modes modes"]]:
    """Estimate the alignments' errors by the residuals of a shape, and what they leave open.

    Args:
        fit: The shape.
        sample: The points, without the errors as they were estimated before.
        shifts: Gives how points move with all errors.
        before: That estimate.
    """
    inside = np.flatnonzero(fit.inliers)
    some = inside[:: max(len(inside) // _MOST, 1)]
    normals = fit.shape.normals(sample.cloud.points[some])
    outwards = np.einsum("ij,ijm->im", normals, shifts(some)[:, :, -len(before) :])
    slopes = fit.slopes[some] / np.maximum(np.linalg.norm(fit.slopes[some], axis=0), 1e-300)
    taken_up, *_ = np.linalg.lstsq(slopes, outwards, rcond=None)
    outwards = outwards - slopes @ taken_up
    weight = len(inside) / len(some) / _variance(fit, sample)
    known = np.eye(len(before)) + weight * outwards.T @ outwards
    change = np.linalg.solve(known, weight * outwards.T @ fit.residuals[some] - before)
    return before + change, np.linalg.inv(np.linalg.cholesky(known)).T


def _lay(
    sample: Sample, shifts: MovesOf, errors: Errors, still_open: Float[np.ndarray, "modes modes"]
) -> Sample:
    """Take the alignments' errors out of the points, and say what is still open."""
    count = len(errors)

    def left(rows: Indices) -> Shifts:
        moves = shifts(rows)
        return np.concatenate([moves[:, :, :-count], moves[:, :, -count:] @ still_open], axis=2)

    points = sample.cloud.points.copy()
    for start in range(0, len(points), _PART):
        rows = np.arange(start, min(start + _PART, len(points)))
        points[rows] -= shifts(rows)[:, :, -count:] @ errors
    return replace(sample, cloud=replace(sample.cloud, points=points), shifts=left)


def _variance(fit: ShapeFit[AnyShape], sample: Sample) -> float:
    """Give the variance of points that would err by themselves and tell as much [m²]."""
    inside = fit.inliers
    slopes, residuals = fit.slopes[inside], fit.residuals[inside]
    own = covariance_of_fit(slopes, residuals, sample.profile[inside], sample.line[inside])
    alone = own.degrees + slopes.shape[1]
    return float(np.sum(residuals**2) / min(alone, len(residuals)))
