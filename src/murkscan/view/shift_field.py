"""How far points move with the errors of their rig, as a few numbers that a page can hold."""

from dataclasses import dataclass
from itertools import product

import numpy as np
from jaxtyping import Float, Int

from ..types.arrays import Points, Vector

Shifts = Float[np.ndarray, "n 3 modes"]
Reduced = Float[np.ndarray, "n 3 kept"]
Terms = Float[np.ndarray, "n terms"]
Powers = Int[np.ndarray, "terms 3"]

_DEGREE = 4
"""Of the polynomial: a rig's errors move points smoothly."""
_LEFT_OUT = 1e-5
"""Share of the variance that the errors which are left out may have."""


@dataclass(frozen=True, eq=False)
class ShiftField:
    """Polynomials over the camera's frame, three for each independent error of the rig.

    The covariance of two points is the product of their shifts.
    """

    centre: Vector
    """Where the polynomials are centred, in the camera's frame [m]."""
    scale: float
    """Length that is 1 for them [m]."""
    coefficients: Float[np.ndarray, "terms 3 kept"]
    """One a term of `powers`, an axis of the camera and an error [m]."""

    @property
    def powers(self) -> Powers:
        """Powers of x, y and z in each term."""
        return _powers()

    def at(self, points: Points) -> Reduced:
        """Give the shifts of points of the camera's frame, along its axes [m]."""
        return np.einsum(
            "nt,tak->nak", _terms((points - self.centre) / self.scale), self.coefficients
        )


def fit_shift_field(points: Points, shifts: Shifts) -> ShiftField:
    """Fit polynomials to the shifts of points, of as few errors as hold nearly all the variance.

    Args:
        points: Points in the camera's frame [m], some hundreds, spread over the scan.
        shifts: How far each moves with each independent error, along the camera's axes [m].
    """
    count, _, modes = shifts.shape
    _, sizes, turned = np.linalg.svd(shifts.reshape(3 * count, modes), full_matrices=False)
    variance = np.cumsum(sizes**2)
    kept = int(np.searchsorted(variance, (1 - _LEFT_OUT) * variance[-1])) + 1
    # Any rotation of independent errors of size 1 is a set of such errors.
    reduced = shifts @ turned[:kept].T
    centre = points.mean(axis=0)
    scale = max(float(np.abs(points - centre).max()), 1e-9)
    terms = _terms((points - centre) / scale)
    # The points lie on a sheet: of what they leave open, the least is taken.
    found = np.linalg.lstsq(terms, reduced.reshape(count, -1), rcond=1e-9)[0]
    return ShiftField(centre, scale, found.reshape(terms.shape[1], 3, kept))


def _powers() -> Powers:
    every = product(range(_DEGREE + 1), repeat=3)
    return np.array([powers for powers in every if sum(powers) <= _DEGREE])


def _terms(points: Points) -> Terms:
    return np.prod(points[:, None, :] ** _powers()[None], axis=2)
