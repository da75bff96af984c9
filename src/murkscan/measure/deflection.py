"""How a wall bends along its height: a curve of distances with their intervals."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from ..geometry.correlated_errors import variances_of_means
from ..types.arrays import Indices, Points, Scalars
from ..types.wall import WallFrame
from .sample import Sample

Group = Int[np.ndarray, "_"]
OfPieces = Int[np.ndarray, "pieces"]
ValuesOfPieces = Float[np.ndarray, "pieces"]
SharesOfPairs = Float[np.ndarray, "lags lags"]

_AROUND = 10.5
"""Cells on either side of a place whose points say how the curve runs there."""
_TERMS, _BENDS = 6, 4
"""Numbers of the surface that does, and of these, those of its bend with the height."""
_ALIKE, _PER_LAG = 2, 40
"""Pieces apart up to which errors may be alike: of the default finder those of profiles next to one
another are by 0.6, two apart hardly; and pieces of a curve that tell each such lag."""
_MOST_TAKEN = 0.75
"""Share that is believed, at most: pieces that stand nearly alone leave nothing to judge by."""
_FEWEST = 8
"""Points of a place, at least."""
_TRACED = 12
"""Points of a place for which the errors of rig and motion are traced."""


@dataclass(frozen=True, eq=False)
class Deflection:
    """The distances of a strip of the wall from its reference, from below upwards."""

    along: float
    """Where the strip's middle is [m]."""
    places: Scalars
    """Along of each place [m]: beside the strip's middle where only a part of it was seen."""
    height: Scalars
    """Of each place [m]."""
    distance: Scalars
    """Out of the wall [m]."""
    sigma_own: Scalars
    """Standard deviation from what differs between points [m]."""
    sigma_common: Scalars | None
    """The same from what the scan shares [m]; None where nothing is stated."""
    points: Indices
    """Points of each place."""

    @property
    def half_width(self) -> Scalars:
        """Half the 95 % interval of each distance [m]."""
        common = 0.0 if self.sigma_common is None else self.sigma_common
        return 1.96 * np.hypot(self.sigma_own, common)


def find_deflection(
    sample: Sample, located: Points, frame: WallFrame, *, along: float, width: float, cell: float
) -> Deflection | None:
    """Follow a strip of the wall up its height.

    Each place is the mean of the points of a piece of the strip. How it errs is told from how the
    points lie about a surface that follows them smoothly, neighbours erring together.

    Args:
        sample: The scan's points.
        located: Their along, height and distance [m].
        frame: The wall's axes.
        along: Middle of the strip [m].
        width: Its width [m].
        cell: Height of a piece [m].

    Returns:
        None where the strip has too few points.
    """
    inside = np.flatnonzero(np.abs(located[:, 0] - along) <= width / 2)
    inside = inside[np.argsort(located[inside, 1], kind="stable")]
    piece = np.floor(located[inside, 1] / cell).astype(int)
    number, first, counts = np.unique(piece, return_index=True, return_counts=True)
    full = counts >= _FEWEST
    if not full.any():
        return None
    errors, variances = _scatter(located[inside], first, counts, cell)
    groups = [np.arange(a, a + n) for a, n in zip(first[full], counts[full], strict=True)]
    profile, line = sample.profile[inside], sample.line[inside]
    own = variances_of_means(groups, errors, variances, profile, line)
    left = np.array([errors[group].mean() for group in groups])
    own *= _widen(left, own, number[full])
    means = np.array([located[inside[group]].mean(axis=0) for group in groups])
    return Deflection(
        along,
        means[:, 0],
        means[:, 1],
        means[:, 2],
        np.sqrt(own),
        _common(sample, located, frame, [inside[group] for group in groups]),
        counts[full],
    )


def _scatter(
    located: Points, first: OfPieces, counts: OfPieces, cell: float
) -> tuple[Scalars, Scalars]:
    """Give how far each point lies from a smooth surface, and the variance of the points around.

    Args:
        located: The strip's points, from below upwards [m].
        first: The first point of each piece.
        counts: Points of each piece.
        cell: Height of a piece [m].
    """
    errors, variances = np.zeros(len(located)), np.zeros(len(located))
    for start, count in zip(first, counts, strict=True):
        middle = float(located[start : start + count, 1].mean())
        ends = np.searchsorted(
            located[:, 1], [middle - _AROUND * cell, middle + _AROUND * cell]
        ).tolist()
        left = _leave(located[slice(*ends)], middle, cell)
        errors[start : start + count] = left[start - ends[0] :][:count]
        degrees = max(len(left) - _TERMS, 1)
        variances[start : start + count] = (left**2).sum() / degrees
    return errors, variances


def _leave(located: Points, middle: float, cell: float) -> Scalars:
    """Give what a surface leaves that bends with the height and leans along the wall."""
    x = (located[:, 0] - located[:, 0].mean()) / cell
    y = (located[:, 1] - middle) / cell
    terms = np.stack([np.ones_like(x), y, y * y, y**3, x, x * y], axis=1)
    if len(located) <= _FEWEST:
        terms = terms[:, :1]
    inverse = np.linalg.pinv(terms.T @ terms, hermitian=True)
    return located[:, 2] - terms @ (inverse @ (terms.T @ located[:, 2]))


def _widen(left: ValuesOfPieces, own: ValuesOfPieces, piece: OfPieces) -> ValuesOfPieces:
    """Give the factor on the variance of each piece's mean, by what the pieces themselves show.

    The surface follows a piece's own error, and the more so if its neighbours err alike, as finders
    do that look at several pictures together: then little of it is left. How alike pieces err that
    are next to one another is told from what is left of them, through what the surface takes of
    each such pair.

    Args:
        left: What is left of each piece's mean [m].
        own: Variance that its points tell of it [m²].
        piece: Number of each, from below.

    References:
        Belsley, Kuh and Welsch, Regression Diagnostics, 1980, section 2.1 (what a fit takes).
    """
    lags = min(_ALIKE, len(piece) // _PER_LAG)
    told = left / np.sqrt(np.maximum(own, 1e-300))
    seen = np.array([_products(told, piece, lag) for lag in range(lags + 1)])
    if not lags:
        seen[0] = 1.0
    alike = np.linalg.lstsq(_what_is_left(lags), seen, rcond=None)[0]
    # Few pieces, or such without noise, may tell ratios that cannot be.
    ratios = np.clip(alike[1:] / max(alike[0], 1e-300), -1.0, 1.0)
    follow = [_share_left(piece - number, ratios) for number in piece.tolist()]
    return seen[0] / np.maximum(follow, 1 - _MOST_TAKEN)


def _products(told: ValuesOfPieces, piece: OfPieces, lag: int) -> float:
    """Give the mean product of pieces that are so far apart."""
    _, first, second = np.intersect1d(piece, piece - lag, return_indices=True)
    return float(np.mean(told[first] * told[second])) if len(first) else 0.0


def _what_is_left(lags: int) -> SharesOfPairs:
    """Give what is left of the products at each lag, for errors that are alike at each lag."""
    reach = int(_AROUND)
    number = np.arange(-2 * reach - lags, 2 * reach + lags + 1)
    takes = np.array(
        [_taken(number, at) for at in range(lags + 1)]
    )  # one row a piece: what is left of it, as weights of all errors
    apart = np.abs(number[:, None] - number)
    return np.array(
        [[float(takes[0] @ (apart == lag) @ takes[at]) for lag in range(lags + 1)]
         for at in range(lags + 1)]
    )  # fmt: skip


def _taken(number: OfPieces, at: int) -> ValuesOfPieces:
    """Give the weights of the errors of pieces in what the surface leaves of one of them."""
    y = (number - at).astype(float)
    near = np.abs(y) <= _AROUND
    terms = np.where(near, y ** np.arange(_BENDS)[:, None], 0.0)
    return (y == 0) - np.linalg.pinv(terms @ terms.T, hermitian=True)[0] @ terms


def _share_left(away: OfPieces, ratios: Scalars) -> float:
    """Give the share of the variance of a piece's error that the surface leaves of it."""
    near = away[np.abs(away) <= _AROUND]
    weights = _taken(near, 0)
    apart = np.abs(near[:, None] - near)
    alike = np.concatenate([[1.0], ratios, [0.0]])[np.minimum(apart, len(ratios) + 1)]
    return float(weights @ alike @ weights)


def _common(
    sample: Sample, located: Points, frame: WallFrame, groups: list[Group]
) -> ValuesOfPieces | None:
    """Give how far the errors that the scan shares move each place out of the wall [m]."""
    if sample.shifts is None:
        return None
    some = [group[:: max(len(group) // _TRACED, 1)] for group in groups]
    chosen = np.concatenate(some)
    out = np.einsum("ij,ijm->im", frame.outwards(located[chosen]), sample.shifts(chosen))
    ends = np.cumsum([len(one) for one in some])[:-1]
    return np.array([np.linalg.norm(np.nanmean(part, axis=0)) for part in np.split(out, ends)])
