"""Lay a model on control points: a turn and a shift, with their covariance and the residuals."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.stats import chi2

from ..errors import Degenerate, InputError, NotEnoughData
from ..types.arrays import Points, Scalars, Vector
from ..types.pose import Pose

_FEWEST = 3
_UNIT = 30.0
"""How many times two lengths may differ before one of them is in another unit."""
_STRETCH = 0.05
"""How much they may differ in the same unit."""
_FIRM = 10.0
"""Spread aside of a line, in standard deviations of a point, from which it holds the turn about it
to a tenth of a radian."""
_THIN = 1e-3
"""The same as a share of the line's length."""
_WRONG = 0.1
"""Residuals, as a share of the points' extent, from which the points are not those of the model."""
_BETTER = 0.1
"""Residuals after a change of columns, as a share of those before, from which it is the cure."""
_RARE = 1e-3
"""Chance of residuals so large at which they are told."""


@dataclass(frozen=True, eq=False)
class ControlFit:
    """A model laid on control points."""

    target_from_model: Pose
    covariance: Float[np.ndarray, "6 6"]
    """Of the turn about the target's origin [rad] and of the shift [m], along its axes; widened
    by the inflation."""
    residuals: Points
    """Control point less model, one a row [m]."""
    standardised: Scalars
    """Length of each residual in its own standard deviations, √3 on average."""
    inflation: float
    """Factor by which the residuals are larger than stated, 1 or more."""
    is_surprising: bool
    """Whether residuals so large come by chance less than once in a thousand."""


@dataclass(frozen=True)
class Mixup:
    """What people exchange in tables of control points."""

    words: str = "easting and northing exchanged: exchange the two columns"
    """The two, and the cure."""
    undo: tuple[tuple[float, ...], ...] = ((0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0))
    """Matrix that exchanges them."""


def fit_control(
    model: Points, control: Points, sigma: Scalars, *, mixup: Mixup = Mixup()
) -> ControlFit:
    """Find the turn and the shift that lay a model on control points, by least squares.

    Args:
        model: Where the points lie on the model [m].
        control: Where they lie in the target's frame [m], near its origin.
        sigma: Standard deviation of each along each axis [m], above 0; that of the place on the
            model included.
        mixup: What may have been exchanged in the control, to be told.

    Raises:
        NotEnoughData: There are fewer than three points.
        Degenerate: They lie on a line.
        InputError: The two sets differ in size, or are not of one another.

    References:
        Horn, Closed-form solution of absolute orientation using unit quaternions, JOSA A 4, 1987;
        Baarda, A testing procedure for use in geodetic networks, 1968, for standardised residuals.
    """
    if len(model) < _FEWEST:
        raise NotEnoughData(
            f"Control needs 3 points or more that are not on a line, got {len(model)}."
        )
    _check_sizes(model, control, sigma)
    pose = _align(model, control, sigma)
    residuals = control - pose @ model
    _check_agreement(model, control, sigma, residuals, mixup)
    moves = _moves(pose @ model)
    weights = 1 / sigma**2
    inverse = np.linalg.inv(np.einsum("nij,n,nik->jk", moves, weights, moves))
    degrees = 3 * len(model) - 6
    total = float((weights * (residuals**2).sum(axis=1)).sum())
    inflation = max(1.0, total / degrees) ** 0.5
    explained = np.einsum("nij,jk,nik->n", moves, inverse, moves) * weights / 3
    own = sigma * np.sqrt(np.maximum(1 - explained, 1e-6))
    return ControlFit(
        pose,
        inverse * inflation**2,
        residuals,
        np.linalg.norm(residuals, axis=1) / own,
        inflation,
        bool(chi2.sf(total, degrees) < _RARE),
    )


def _align(model: Points, control: Points, sigma: Scalars) -> Pose:
    """Find the pose of least weighted squares (Horn; by singular values)."""
    weights = (1 / sigma**2 / (1 / sigma**2).sum())[:, None]
    middle, target = (weights * model).sum(axis=0), (weights * control).sum(axis=0)
    spread = (weights * (control - target)).T @ (model - middle)
    left, _, right = np.linalg.svd(spread)
    sign = np.diag([1.0, 1.0, np.sign(np.linalg.det(left @ right))])
    rotation = left @ sign @ right
    return Pose(rotation, target - rotation @ middle)


def _moves(points: Points) -> Float[np.ndarray, "n 3 6"]:
    """Give the shift of each point with a turn about the origin and with a shift."""
    axes = np.eye(3)
    turns = np.stack([np.cross(axis, points) for axis in axes], axis=2)
    return np.concatenate([turns, np.broadcast_to(axes, (len(points), 3, 3))], axis=2)


def _check_sizes(model: Points, control: Points, sigma: Scalars) -> None:
    """Refuse what is in another unit, known too badly, or on a line."""
    spreads = [np.linalg.svd(p - p.mean(axis=0), compute_uv=False) for p in (model, control)]
    on_model, on_ground = (float(np.linalg.norm(spread)) for spread in spreads)
    extent = _extent(control)
    if sigma.max() > extent / 2:
        raise InputError(
            f"A sigma of {1e3 * sigma.max():g} mm for control points that lie {extent:.3g} m apart "
            "determines nothing; was it meant in another unit?"
        )
    for spread, where in zip(spreads, ("on the model", "on the ground"), strict=True):
        if spread[1] < max(_FIRM * float(np.sqrt(np.mean(sigma**2))), _THIN * spread[0]):
            raise Degenerate(
                f"The control points lie on a line {where}, to {1e3 * spread[1]:.0f} mm, about "
                "which the model may turn; add a point aside of it."
            )
    ratio = on_ground / on_model
    if not 1 / _UNIT < ratio < _UNIT:
        raise InputError(
            f"The control points lie {ratio:.4g} times as far apart as on the model: one of the "
            "two is not in metres."
        )
    if abs(ratio - 1) > _STRETCH + _FIRM * sigma.max() / extent:
        raise InputError(
            f"The control points lie {ratio:.4g} times as far apart as on the model, on average: "
            "check their units, and which place on the model belongs to which point."
        )


def _check_agreement(
    model: Points, control: Points, sigma: Scalars, residuals: Points, mixup: Mixup
) -> None:
    """Refuse points that are not those of the model."""
    worst = float(np.linalg.norm(residuals, axis=1).max())
    if worst < max(_WRONG * _extent(control), _FIRM * sigma.max()):
        return
    swapped = control @ np.array(mixup.undo).T
    left = np.linalg.norm(swapped - _align(model, swapped, sigma) @ model, axis=1).max()
    if left < _BETTER * worst:
        raise InputError(
            f"The model misses a control point by {worst:.3g} m, but only by {left:.2g} m with "
            f"{mixup.words}."
        )
    number = int(np.linalg.norm(residuals, axis=1).argmax()) + 1
    raise InputError(
        f"The model misses control point {number} by {worst:.3g} m, with points "
        f"{_extent(control):.3g} m apart: check which place on the model belongs to which point."
    )


def _extent(points: Points) -> float:
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def centre_of(control: Points) -> Vector:
    """Give the whole metres next to the middle of control points: a place to count from."""
    return np.round(control.mean(axis=0))
