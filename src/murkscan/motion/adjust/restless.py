"""What a restless vehicle makes of a surface, if its way is not known: bumps that no surface has.

A profile that lies too high or is turned by an error of the way moves all of its row, by what grows
evenly across it. So what a row has in common counts only as far as the way is known better.
"""

import numpy as np
from jaxtyping import Float
from scipy.ndimage import uniform_filter1d

from ...types.arrays import Scalars
from .legs import Facets, leg_direction
from .path import Path

_SLOWEST = 0.01
"""Speed below which what a way makes is not stretched along it any more [m/s]."""
_ROWS = 5
"""Rows over which mean squares are taken: a weld seam is as wide [cells]."""
_CERTAIN = 2.0
"""How many times over its noise a mean square of many must stand to count."""
_PEAK = 9.0
"""The same of some rows: noise of neighbours goes together, and a wave of a way is as wide as they
are, so that their mean square is about that of one draw, of up to 3 σ."""
_SHARED = 3
"""Columns whose planes share their points."""

Squares = Float[np.ndarray, "..."]
"""Mean squares."""
Errors = Float[np.ndarray, "r m"]
"""Of each row, some that it may have."""


def share_of_signal(seen: Squares, noise: Squares, certain: float = _CERTAIN) -> Squares:
    """Compute the share of mean squares that is no noise, with certainty.

    References:
        James and Stein, Estimation with quadratic loss, 1961.
    """
    return np.asarray(np.clip(1 - certain * noise / np.maximum(seen, 1e-300), 0, 1))


def fit_rows(facets: Facets, values: Float[np.ndarray, "n k"]) -> Float[np.ndarray, "n k"]:
    """Fit what all facets of a row have in common: a value, and one that grows evenly across."""
    held = np.maximum(np.bincount(facets.row), 1)[:, None]

    def total(values: Float[np.ndarray, "n j"]) -> Float[np.ndarray, "r j"]:
        return np.stack([np.bincount(facets.row, v) for v in values.T], axis=1)

    aside = facets.column - (total(facets.column[:, None] * 1.0) / held)[facets.row, 0]
    square = np.maximum(np.bincount(facets.row, aside**2), 1e-12)[:, None]
    grows = total(aside[:, None] * values) / square
    return np.asarray((total(values) / held)[facets.row] + aside[:, None] * grows[facets.row])


def keep_rows(
    facets: Facets,
    common: Float[np.ndarray, "n k"],
    noise: Float[np.ndarray, "n k"],
    made: Float[np.ndarray, "r k"] | None,
) -> Float[np.ndarray, "n k"]:
    """Keep the share of what rows have in common that is no noise, theirs or of the way.

    Args:
        facets: The leg.
        common: Of `fit_rows`.
        noise: Variance of each facet's own values.
        made: Variance that errors of the way make of each row; None: of a way without errors.
    """
    count = np.bincount(facets.row)
    of_row = 2 * _SHARED * noise / count[facets.row, None]
    if made is not None:
        of_row = of_row + made[facets.row]

    def mean(values: Float[np.ndarray, "n k"]) -> Float[np.ndarray, "b k"]:
        rows = np.stack([np.bincount(facets.row, v) for v in values.T], axis=1)
        held = np.maximum(uniform_filter1d(count * 1.0, _ROWS), 1e-12)
        return np.asarray(uniform_filter1d(rows, _ROWS, axis=0) / held[:, None])

    keep = share_of_signal(mean(common**2), mean(of_row), _PEAK)
    return np.asarray(keep[facets.row] * common)


def slopes_of_errors(
    facets: Facets, path: Path, errors: Float[np.ndarray, "k 6 m"]
) -> Float[np.ndarray, "r 2"]:
    """Compute the variance of slopes along the way and across it that errors make of each row.

    A profile that lies too high by one error and the next one by another make a slope along the
    way; one that is rolled is a slope across it.

    Args:
        facets: The leg.
        path: Where it lies.
        errors: Some that its control values may have, drawn.
    """
    high, rolled, width = _lift_rows(facets, path, errors)
    times = facets.leg.row_times
    speed = path.velocity(times) @ leg_direction(path, times)
    pace = np.maximum(np.abs(speed), _SLOWEST)[:, None]
    along, twist = (np.gradient(one, times, axis=0) / pace for one in (high, rolled))
    # A steady turn of the whole leg makes it no less smooth.
    steady = np.stack([np.ones_like(times), times - times.mean()], axis=1)
    rolled = rolled - steady @ np.linalg.lstsq(steady, rolled, rcond=None)[0]
    made = (along**2 + (width * twist) ** 2, rolled**2)
    return np.stack([one.mean(axis=1) for one in made], axis=1)


def heights_of_errors(
    facets: Facets, path: Path, errors: Float[np.ndarray, "k 6 m"], window: int
) -> Scalars:
    """Compute the variance of heights out of the mean of some rows that errors make of each row.

    Args:
        facets: The leg.
        path: Where it lies.
        errors: Some that its control values may have, drawn.
        window: Count of rows of that mean.
    """
    high, rolled, width = _lift_rows(facets, path, errors)
    made = [one - uniform_filter1d(one, window, axis=0) for one in (high, width * rolled)]
    return np.asarray((made[0] ** 2 + made[1] ** 2).mean(axis=1))


def _lift_rows(
    facets: Facets, path: Path, errors: Float[np.ndarray, "k 6 m"]
) -> tuple[Errors, Errors, float]:
    """Give how errors lift rows along the surface's normal [m] and roll them [rad].

    And how far aside of a row's middle its facets lie, RMS [m].
    """
    leg = facets.leg
    poses = path.at(leg.row_times)
    near = np.einsum("nj,njdm->ndm", poses.weights, errors[poses.first[:, None] + np.arange(4)])
    turns = np.einsum("nij,njm->nim", poses.turned_by, near[:, 3:])
    normal = facets.normals.mean(axis=0)
    normal /= np.linalg.norm(normal)
    side = np.cross(normal, leg_direction(path, leg.row_times))
    side /= np.linalg.norm(side)
    arms = np.einsum("nij,nj->ni", poses.rotations, leg.row_points)
    high = np.einsum("i,nim->nm", normal, near[:, :3])
    high += np.einsum("ni,nim->nm", np.cross(arms, normal), turns)
    rolled = np.einsum("i,nim->nm", np.cross(side, normal), turns)
    return high, rolled, float(np.ptp(facets.points @ side) / np.sqrt(12))
