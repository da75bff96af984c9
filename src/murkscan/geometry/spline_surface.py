"""A smooth surface under a map's heights, of which some are dents, bumps or slips."""

import math
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy import sparse
from scipy.interpolate import BSpline
from scipy.sparse.linalg import spsolve

from ..errors import InputError, NotEnoughData
from ..types.arrays import Scalars

_DEGREE = 3
_NUM_ROUNDS = 40
"""Rounds of weighing at most; some ten are enough."""
_TUKEY = 4.685
"""Standard deviations beyond which a height counts nothing: 95 % as exact as least squares where
nothing is wrong."""
_GAUSSIAN = 1.4826
_STIFFNESS = 1e-7
"""Weight of the surface's bending against its heights: it only holds where there are none."""
_STEP = 1e-4
"""Shift of a place for the surface's slope there [m]."""
_MOST_COEFFICIENTS = 12_000
"""Coefficients whose covariance still fits into the memory of ordinary machines: 1.2 GB."""
_SETTLED = 1e-7
"""Change of the surface after which it is done [m]."""
_FEW = 64
"""Coefficients up to which a whole matrix is sooner than a sparse one. For 3500 heights a fit takes
7 times as long with a sparse one at 16 coefficients, twice as long at 49, and as long at 121."""

Places = Float[np.ndarray, "n 2"]
Knots = Float[np.ndarray, "_"]
_Matrix = sparse.csr_matrix | Float[np.ndarray, "_ _"]


@dataclass(frozen=True, eq=False)
class SplineSurface:
    """Heights by a tensor product of cubic B-splines."""

    knots: tuple[Knots, Knots]
    """Knots along both directions, with the ends repeated [m]."""
    coefficients: Float[np.ndarray, " k"]
    """Coefficients, the second direction's running fastest [m]."""
    covariance: Float[np.ndarray, "k k"]
    """Covariance of the coefficients for errors of their own in each height [m²]."""

    def heights(self, places: Places) -> Scalars:
        """Give the height at places within the knots [m]."""
        return _design(places, self.knots) @ self.coefficients

    def sigma(self, places: Places) -> Scalars:
        """Give the standard deviation of the surface at places [m]."""
        design = _design(places, self.knots)
        variance = np.asarray(design.multiply(design @ self.covariance).sum(axis=1)).ravel()
        return np.sqrt(np.maximum(variance, 0.0))

    def normals(self, places: Places) -> Float[np.ndarray, "n 3"]:
        """Give the unit normal, upwards, at places."""
        slopes = [
            (self.heights(places + side) - self.heights(places - side)) / (2 * _STEP)
            for side in _STEP * np.eye(2)
        ]
        upright = np.stack([-slopes[0], -slopes[1], np.ones(len(places))], axis=1)
        return upright / np.linalg.norm(upright, axis=1, keepdims=True)


def fit_spline_surface(
    places: Places, heights: Scalars, *, spacing: float, extent: tuple[float, float]
) -> SplineSurface:
    """Fit a surface that is smooth over a spacing, by least squares on the heights that agree.

    Heights lose weight the farther they are from the surface, and count nothing beyond 4.7 robust
    standard deviations (Tukey's biweight): what is narrower than the spacing stands out of it.

    Args:
        places: Where each height is [m].
        heights: The heights [m].
        spacing: Distance between knots, at most [m].
        extent: How far the surface reaches from 0 in both directions [m].

    Raises:
        NotEnoughData: There are fewer heights than the surface has coefficients.
        InputError: The spacing is so small that there are too many.

    References:
        Beaton and Tukey, The fitting of power series, Technometrics 16(2), 1974 (the weights).
        Eilers and Marx, Flexible smoothing with B-splines and penalties, Stat. Sci. 11(2), 1996.
    """
    count = math.prod(side / spacing + _DEGREE for side in extent)
    if count > _MOST_COEFFICIENTS:
        raise InputError(
            f"A surface smooth over {spacing * 1e3:g} mm has {count:.3g} coefficients here, "
            f"more than {_MOST_COEFFICIENTS:,}; measure a part of the scan, or look for larger "
            "things."
        )
    knots = (_lay_knots(extent[0], spacing), _lay_knots(extent[1], spacing))
    design = _as_quickest(_design(places, knots))
    if len(places) <= design.shape[1]:
        raise NotEnoughData(
            f"A smooth surface of {design.shape[1]} coefficients needs more heights than that, got "
            f"{len(places)}; measure a larger part of the scan."
        )
    shape = (len(knots[0]) - _DEGREE - 1, len(knots[1]) - _DEGREE - 1)
    bending = _as_quickest(_bending(shape)) * (_STIFFNESS * len(places) / design.shape[1])
    turned = design.T if isinstance(design, np.ndarray) else sparse.csr_matrix(design.T)
    weights, surface = np.ones(len(places)), np.full(len(places), np.inf)
    for _ in range(_NUM_ROUNDS):
        normal = turned @ _weigh(design, weights) + bending
        coefficients = _solve(normal, turned @ (weights * heights))
        before, surface = surface, design @ coefficients
        off = heights - surface
        scale = max(_GAUSSIAN * float(np.median(np.abs(off))), 1e-9)
        weights = np.clip(1 - (off / (_TUKEY * scale)) ** 2, 0.0, None) ** 2
        if np.abs(surface - before).max() < _SETTLED:
            break
    whole = normal if isinstance(normal, np.ndarray) else normal.toarray()
    covariance = scale**2 * np.linalg.inv(whole)
    return SplineSurface(knots, coefficients, covariance)


def _as_quickest(matrix: sparse.csr_matrix) -> _Matrix:
    return np.asarray(matrix.toarray()) if matrix.shape[1] <= _FEW else matrix


def _weigh(design: _Matrix, weights: Scalars) -> _Matrix:
    if isinstance(design, np.ndarray):
        return weights[:, None] * design
    data = design.data * np.repeat(weights, np.diff(design.indptr))
    return sparse.csr_matrix((data, design.indices, design.indptr), shape=design.shape)


def _solve(normal: _Matrix, right: Scalars) -> Scalars:
    if isinstance(normal, np.ndarray):
        return np.linalg.solve(normal, right)
    # The same matrix by columns, since it is symmetric.
    by_columns = sparse.csc_matrix((normal.data, normal.indices, normal.indptr), normal.shape)
    return np.asarray(spsolve(by_columns, right))


def _lay_knots(extent: float, spacing: float) -> Knots:
    # Slopes are taken a little beyond the rim, too.
    low, high = -_STEP, extent + _STEP
    inner = np.linspace(low, high, max(math.ceil(extent / spacing), 1) + 1)
    return np.concatenate([[low] * _DEGREE, inner, [high] * _DEGREE])


def _design(places: Places, knots: tuple[Knots, Knots]) -> sparse.csr_matrix:
    """Give the weight of each coefficient at each place."""
    count, width = len(places), _DEGREE + 1
    sides = []
    for values, line in zip(places.T, knots, strict=True):
        inside = np.clip(values, line[0], line[-1])
        made = BSpline.design_matrix(inside, line, _DEGREE)
        sides.append((made.data.reshape(count, width), made.indices.reshape(count, width)))
    (first, i), (second, j) = sides
    num_second = len(knots[1]) - _DEGREE - 1
    data = (first[:, :, None] * second[:, None, :]).ravel()
    column = (i[:, :, None] * num_second + j[:, None, :]).ravel()
    row = np.repeat(np.arange(count), width * width)
    total = (len(knots[0]) - _DEGREE - 1) * num_second
    return sparse.csr_matrix((data, (row, column)), shape=(count, total))


def _bending(shape: tuple[int, int]) -> sparse.csr_matrix:
    """Give the sum of the squares of second differences as a matrix."""
    parts = []
    for axis, count in enumerate(shape):
        second = sparse.csr_matrix(np.diff(np.eye(count), 2, axis=0))
        eye = sparse.eye_array(shape[1 - axis])
        along = sparse.kron(second, eye) if axis == 0 else sparse.kron(eye, second)
        parts.append(along.T @ along)
    return sparse.csr_matrix(parts[0] + parts[1])
