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
SharesOfPieces = Float[np.ndarray, "pieces"]

_AROUND = 10.5
"""Cells on either side of a place whose points say how the curve runs there."""
_TERMS = 6
"""Numbers of the surface that does."""
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
    points lie about a curve that follows them smoothly, neighbours erring together.

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
    height, distance = located[inside, 1], located[inside, 2]
    piece = np.floor(height / cell).astype(int)
    _, first, counts = np.unique(piece, return_index=True, return_counts=True)
    full = counts >= _FEWEST
    if not full.any():
        return None
    errors, variances, taken = _scatter(located[inside], first, counts, cell)
    groups = [np.arange(a, a + n) for a, n in zip(first[full], counts[full], strict=True)]
    own = variances_of_means(groups, errors, variances, sample.profile[inside], sample.line[inside])
    return Deflection(
        along,
        np.array([height[group].mean() for group in groups]),
        np.array([distance[group].mean() for group in groups]),
        np.sqrt(own / (1 - taken[full])),
        _common(sample, located, frame, [inside[group] for group in groups]),
        counts[full],
    )


def _scatter(
    located: Points, first: OfPieces, counts: OfPieces, cell: float
) -> tuple[Scalars, Scalars, SharesOfPieces]:
    """Give how far each point lies from a smooth surface, and the variance of the points around.

    The surface follows a piece's own error a little; the last numbers are the share of the variance
    of each piece's mean that is lost by that.

    Args:
        located: The strip's points, from below upwards [m].
        first: The first point of each piece.
        counts: Points of each piece.
        cell: Height of a piece [m].
    """
    errors, variances = np.zeros(len(located)), np.zeros(len(located))
    taken = np.zeros(len(first))
    for number, (start, count) in enumerate(zip(first, counts, strict=True)):
        middle = float(located[start : start + count, 1].mean())
        ends = np.searchsorted(
            located[:, 1], [middle - _AROUND * cell, middle + _AROUND * cell]
        ).tolist()
        around = slice(*ends)
        mine = slice(start - ends[0], start - ends[0] + count)
        left, taken[number] = _leave(located[around], middle, cell, mine)
        errors[start : start + count] = left[mine]
        degrees = max(len(left) - _TERMS, 1)
        variances[start : start + count] = (left**2).sum() / degrees
    return errors, variances, taken


def _leave(located: Points, middle: float, cell: float, mine: slice) -> tuple[Scalars, float]:
    """Give what a surface leaves that bends with the height and leans along the wall.

    And the share of the variance of the mean of some points that it takes.

    References:
        Belsley, Kuh and Welsch, Regression Diagnostics, 1980, section 2.1 (leverage).
    """
    x = (located[:, 0] - located[:, 0].mean()) / cell
    y = (located[:, 1] - middle) / cell
    terms = np.stack([np.ones_like(x), y, y * y, y**3, x, x * y], axis=1)
    if len(located) <= _FEWEST:
        terms = terms[:, :1]
    inverse = np.linalg.pinv(terms.T @ terms, hermitian=True)
    left = located[:, 2] - terms @ (inverse @ (terms.T @ located[:, 2]))
    mean = terms[mine].mean(axis=0)
    share = float(mean @ inverse @ mean) * (mine.stop - mine.start)
    return left, min(share, _MOST_TAKEN)


def _common(
    sample: Sample, located: Points, frame: WallFrame, groups: list[Group]
) -> SharesOfPieces | None:
    """Give how far the errors that the scan shares move each place out of the wall [m]."""
    if sample.shifts is None:
        return None
    some = [group[:: max(len(group) // _TRACED, 1)] for group in groups]
    chosen = np.concatenate(some)
    out = np.einsum("ij,ijm->im", frame.outwards(located[chosen]), sample.shifts(chosen))
    ends = np.cumsum([len(one) for one in some])[:-1]
    return np.array([np.linalg.norm(np.nanmean(part, axis=0)) for part in np.split(out, ends)])
