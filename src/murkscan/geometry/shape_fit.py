"""Shapes through points of which some are wrong: least squares on those that agree."""

from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np
from jaxtyping import Float

from ..errors import Degenerate, InputError, NotConverged, NotEnoughData
from ..types.arrays import Mask, Points, Scalars, Vector
from .shape import AnyShape, Slopes
from .stripe_blur import Sight, blur_moves, is_readable, moves_put_back, sheet_moves

_GAUSSIAN = 1.4826
"""Standard deviation of Gaussian noise as a multiple of its median absolute value."""
_NUM_STEPS = 60
"""Steps at most; from a fair start six to ten are enough."""
_NUM_CHOICES = 20
"""Steps in which inliers are chosen anew: a point at the border could go in and out for ever."""
_SETTLED = 1e-9
"""Largest move of any point's distance after which nothing more will happen [m]."""
_WEAK = 1e-6
"""Smallest singular value over the largest, of columns of equal length, below which a parameter is
open."""

Shape = TypeVar("Shape", bound=AnyShape)
SomeShape = TypeVar("SomeShape", bound=AnyShape, covariant=True)


@dataclass(frozen=True, eq=False)
class ShapeFit(Generic[SomeShape]):
    """A shape, and how well each point agrees."""

    shape: SomeShape
    """The shape of the inliers, least squares."""
    residuals: Scalars
    """Signed distance of every point [m], less what the blur of the stripe explains."""
    inliers: Mask
    """Which points the shape was fitted to."""
    slopes: Slopes
    """How each residual changes with the shape's parameters, whose tilts are about `middle`, and
    last, where the fit knows from where the points were seen and the shape is curved, with the
    variance of the stripe's blur [m²]."""
    middle: Vector
    """Mean of all points [m]."""
    blur: float = 0.0
    """Variance of the stripe's blur along the stripe, as fitted [m²]; 0 where it is none of the
    fit's parameters."""

    @property
    def rms(self) -> float:
        """Root mean square residual of the inliers [m]."""
        return float(np.sqrt(np.mean(self.residuals[self.inliers] ** 2)))

    def shifted(self, offset: Vector) -> "ShapeFit[SomeShape]":
        """Move shape and points as a whole [m]."""
        moved, middle = self.shape.shifted(offset), self.middle + offset
        return ShapeFit(moved, self.residuals, self.inliers, self.slopes, middle, self.blur)

    def moved(
        self, step: Float[np.ndarray, " p"], points: Points, sight: Sight
    ) -> "ShapeFit[SomeShape]":
        """Change the parameters of a fit to points that were seen from a sight, as in `slopes`."""
        own = len(step) - 1
        shape, blur = self.shape.moved(step[:own]), self.blur + float(step[own])
        residuals, slopes, _ = _linearise(shape, points, sight, blur)
        return ShapeFit(shape, residuals, self.inliers, slopes, self.middle, blur)


def require_points(points: Points, least: int, what: str) -> None:
    """Refuse points that are too few, or not finite.

    Raises:
        NotEnoughData: There are fewer than `least`.
        InputError: One is not finite.
    """
    broken = len(points) - int(np.isfinite(points).all(axis=1).sum())
    if broken:
        raise InputError(f"{broken} of {len(points)} points are not finite; leave them out.")
    if len(points) < least:
        raise NotEnoughData(
            f"A {what} needs at least {least} points, got {len(points)}; choose a larger part of "
            "the scan."
        )


def refine_shape(
    start: Shape,
    points: Points,
    *,
    sight: Sight | None = None,
    reach: float = 4.0,
    tolerance: float = 1e-9,
) -> ShapeFit[Shape]:
    """Fit a shape to the points near it, by Gauss-Newton steps until nothing changes.

    Where it is known from where the points were seen, the blur of the stripe is a parameter beside
    those of a curved shape, and places that turn away along the stripe do not count.

    Args:
        start: Where to begin, in the frame of the points; tilts are about the origin, which should
            lie among the points.
        points: Points [m], finite.
        sight: From where each was seen.
        reach: How many robust standard deviations from the shape an inlier may lie.
        tolerance: Distance [m] within which a point is an inlier in any case.

    Raises:
        NotEnoughData: Fewer points than parameters agree.
        Degenerate: The points that agree leave a parameter open.
        NotConverged: The steps do not end.
    """
    shape, blur, inliers = start, 0.0, np.ones(len(points), bool)
    for number in range(_NUM_STEPS):
        residuals, slopes, readable = _linearise(shape, points, sight, blur)
        if number < _NUM_CHOICES:
            spread = _GAUSSIAN * _median(np.abs(residuals[readable]))
            inliers = readable & (np.abs(residuals) <= max(reach * spread, tolerance))
        step = _solve(slopes[inliers], -residuals[inliers])
        own = start.slopes(points[:1]).shape[1]
        shape, blur = shape.moved(step[:own]), blur + float(step[own:].sum())
        if np.abs(slopes[inliers] @ step).max() < _SETTLED:
            break
    else:
        raise NotConverged(
            f"The fit to {len(points)} points did not settle in {_NUM_STEPS} steps; choose points "
            "of one surface only."
        )
    residuals, slopes, _ = _linearise(shape, points, sight, blur)
    return ShapeFit(shape, residuals, inliers, slopes, points.mean(axis=0), blur)


def _linearise(
    shape: AnyShape, points: Points, sight: Sight | None, blur: float
) -> tuple[Scalars, Slopes, Mask]:
    """Give residuals, their slopes, and which points the stripe shows well."""
    residuals, slopes = shape.distance_to(points), shape.slopes(points)
    if sight is None:
        return residuals, slopes, np.ones(len(points), bool)
    moved, by_blur = blur_moves(shape, points, sight, blur)
    readable = is_readable(shape, points, sight)
    if not np.any(by_blur):
        return residuals, slopes, readable
    slopes = np.concatenate([slopes, -by_blur[:, None]], axis=1)
    moved = moved + sheet_moves(shape, points, sight) + moves_put_back(shape, points, sight)
    return residuals - moved, slopes, readable


def _median(values: Scalars) -> float:
    return float(np.median(values)) if len(values) else 0.0


def _solve(slopes: Slopes, wanted: Scalars) -> Float[np.ndarray, " p"]:
    if len(slopes) <= slopes.shape[1]:
        raise NotEnoughData(
            f"Only {len(slopes)} points agree with one shape, {slopes.shape[1] + 1} are needed; "
            "choose points of one surface only."
        )
    lengths = np.maximum(np.linalg.norm(slopes, axis=0), 1e-300)
    step, _, rank, sizes = np.linalg.lstsq(slopes / lengths, wanted, rcond=None)
    if rank < slopes.shape[1] or sizes[-1] < _WEAK * sizes[0]:
        raise Degenerate(
            f"The {len(slopes)} points cover too little of the shape to tell its size and place; "
            "choose a larger part of it."
        )
    return step / lengths
