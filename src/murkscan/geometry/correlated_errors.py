"""The covariance of a least-squares fit whose points err together with their neighbours.

A finder's error depends on where in its pixel the stripe lies, on the paint and on the glow: points
that lie next to each other are off by nearly the same. Ten thousand points then tell no more than
the few hundred patches in which they agree, and the usual covariance is far too small.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int
from scipy.ndimage import convolve1d

from ..types.arrays import Indices, Scalars
from .shape import Slopes

Group = Int[np.ndarray, "_"]

_QUIET_LAGS = 4
"""Lags in a row without correlation after which there is none."""
_SIGNIFICANT = 2.0
"""Standard deviations of a correlation's noise above which it is one."""
_MOST_LAGS = 64
"""Cells over which a correlation is looked for."""
_LARGEST_SHARE = 0.25
"""Share of the grid's extent over which errors are taken to hang together at most: of less than
four patches no spread can be told."""
_WIDTH = 2
"""Reaches within which pairs of points count, less and less."""
_FLOOR = 0.25
"""Share of the variance of independent errors below which none is believed: fringes that cancel
along a profile are real, but not for ever."""


@dataclass(frozen=True, eq=False)
class FitCovariance:
    """How well a fit's parameters are determined by its points."""

    matrix: Float[np.ndarray, "p p"]
    """Covariance of the parameters."""
    degrees: float
    """Independent patches of error that were seen, less the parameters; at least 1."""
    reach: tuple[int, int]
    """Profiles, and scan lines, over which errors hang together."""


@dataclass(frozen=True, eq=False)
class _Cells:
    """Points in a dense grid of profiles and scan lines."""

    profile: Indices
    line: Indices

    @classmethod
    def of(cls, profile: Indices, line: Indices) -> "_Cells":
        _, compact = np.unique(profile, return_inverse=True)
        # Profiles that follow one another stay neighbours, gaps and other passes shrink to a gap.
        numbers = np.unique(profile)
        steps = np.minimum(np.diff(numbers), _MOST_LAGS)
        packed = np.concatenate([[0], np.cumsum(steps)])[compact]
        return cls(packed, line - line.min())

    @property
    def shape(self) -> tuple[int, int]:
        return int(self.profile.max()) + 1, int(self.line.max()) + 1

    def fill(self, values: Scalars) -> Float[np.ndarray, "h w"]:
        """Sum the values of each cell; 0 where there is none."""
        height, width = self.shape
        cell = self.profile * width + self.line
        return np.bincount(cell, values, height * width).reshape(height, width)


def covariance_of_fit(
    slopes: Slopes, residuals: Scalars, profile: Indices, line: Indices
) -> FitCovariance:
    """Give the covariance of the parameters of a least-squares fit from its own residuals.

    How far errors hang together, along the profiles and across them, is read off the residuals'
    correlation; then the products of all pairs of points within twice that reach are
    summed. That holds whatever the errors' size, which may differ from place to place. What
    the whole of the points share, such as the rig's own error, no residual shows.

    Args:
        slopes: Change of each residual with each parameter.
        residuals: What is left of each point [m].
        profile: Number of each point's profile; those that follow one another differ by 1.
        line: Number of each point's scan line.

    References:
        Conley, GMM estimation with cross sectional dependence, J. Econometrics 92, 1999.
        Newey and West, A simple, positive semi-definite, heteroskedasticity and autocorrelation
        consistent covariance matrix, Econometrica 55(3), 1987 (the weights).
        Kiefer and Vogelsang, A new asymptotic theory for heteroskedasticity-autocorrelation robust
        tests, Econometric Theory 21(6), 2005, table 1 (what few independent patches leave open).
        Politis and White, Automatic block-length selection for the dependent bootstrap,
        Econometric Reviews 23(1), 2004, section 3.2 (the reach).
    """
    count, parameters = slopes.shape
    cells = _Cells.of(profile, line)
    reach = _find_reach(cells, residuals)
    # Scaled, so that metres and radians do not spoil the inverse.
    scale = np.maximum(np.linalg.norm(slopes, axis=0), 1e-300)
    scaled = slopes / scale
    bread = np.linalg.pinv(scaled.T @ scaled, hermitian=True)
    meat = _sum_pairs(cells, scaled * residuals[:, None], reach)
    single = scaled.T @ (scaled * (residuals**2)[:, None])
    meat = _at_least(meat, _FLOOR * single)
    inflation = float(np.trace(bread @ meat) / max(np.trace(bread @ single), 1e-300))
    degrees = max(count / max(inflation, 1.0) - parameters, 1.0)
    correction = (degrees + parameters) / degrees * _widen(cells, reach)
    matrix = correction * (bread @ meat @ bread) / np.outer(scale, scale)
    return FitCovariance(matrix, degrees, reach)


def covariance_of_sums(
    weights: Slopes, errors: Scalars, profile: Indices, line: Indices
) -> Float[np.ndarray, "p p"]:
    """Give the covariance of weighted sums of errors, from the errors themselves.

    Args:
        weights: Weight of each error in each sum.
        errors: How far each point is off, such as its distance from a smooth surface [m].
        profile: Number of each point's profile.
        line: Number of each point's scan line.

    References:
        As for `covariance_of_fit`.
    """
    cells = _Cells.of(profile, line)
    moments = weights * errors[:, None]
    scale = np.maximum(np.linalg.norm(moments, axis=0), 1e-300)
    moments = moments / scale
    reach = _find_reach(cells, errors)
    pairs = _sum_pairs(cells, moments, reach)
    found = _at_least(pairs, _FLOOR * moments.T @ moments) * np.outer(scale, scale)
    return found * _widen(cells, reach)


def variance_of_sum(weights: Scalars, errors: Scalars, profile: Indices, line: Indices) -> float:
    """Give the variance of a weighted sum of errors, from their size and reach alone.

    What is left by a smooth surface does not sum to anything any more, however far the surface is
    off as a whole; its size, and its correlation at each lag along profiles and across them, still
    tell by how much.

    Args:
        weights: Weight of each error in the sum.
        errors: How far each point is off from a smooth surface [m].
        profile: Number of each point's profile.
        line: Number of each point's scan line.
    """
    cells = _Cells.of(profile, line)
    values, there = _mean_errors(cells, errors)
    spread = filled = cells.fill(weights)
    half_lengths = []
    for axis, reach in enumerate(_find_reach(cells, errors)):
        turned = (values, there) if axis == 0 else (values.T, there.T)
        known = np.clip(_correlations(*turned, reach), 0.0, None)
        both = np.append(known[:0:-1], known)
        spread = convolve1d(spread, both, axis=axis, mode="constant")
        half_lengths.append(float(both.sum()) / _WIDTH)
    return float((filled * spread).sum() * np.mean(errors**2)) * _widen(cells, half_lengths)


def variances_of_means(
    groups: Sequence[Group],
    errors: Scalars,
    variances: Scalars,
    profile: Indices,
    line: Indices,
) -> Float[np.ndarray, " groups"]:
    """Give the variance of the mean error of each of many small groups of points.

    How errors hang together along profiles and across them is told from all points, by their
    correlation at each lag.

    Args:
        groups: Which points are in each group.
        errors: How far each point is off from a smooth curve or surface [m].
        variances: Of each point's error [m²].
        profile: Number of each point's profile.
        line: Number of each point's scan line.

    References:
        As for `covariance_of_fit`.
    """
    cells = _Cells.of(profile, line)
    values, there = _mean_errors(cells, errors)
    across, along = (
        _correlations(grid, seen, min(len(grid), _MOST_LAGS))
        for grid, seen in ((values, there), (values.T, there.T))
    )
    found = np.empty(len(groups))
    for number, group in enumerate(groups):
        shares = np.ones((len(group), len(group)))
        for places, known in ((cells.profile[group], across), (cells.line[group], along)):
            lags = np.abs(places[:, None] - places[None, :])
            shares *= np.append(known, 0.0)[np.minimum(lags, len(known))]
        least = _FLOOR / len(group)
        found[number] = max(shares.mean(), least) * np.mean(variances[group])
    return found


def _mean_errors(cells: _Cells, errors: Scalars) -> tuple[np.ndarray, np.ndarray]:
    """Give the mean error of each cell, 0 where there is none, and 1 where there is one."""
    values, there = cells.fill(errors), cells.fill(np.ones_like(errors))
    values = np.divide(values, there, out=np.zeros_like(values), where=there > 0)
    return values, (there > 0).astype(float)


def _correlations(values: np.ndarray, there: np.ndarray, reach: int) -> Scalars:
    """Give the correlation along the first axis at each lag below the reach; 1 at lag 0."""
    variance = max(float((values**2).sum() / max(there.sum(), 1.0)), 1e-300)
    found = [1.0]
    for lag in range(1, reach):
        pairs = max(float((there[lag:] * there[:-lag]).sum()), 1.0)
        found.append(float((values[lag:] * values[:-lag]).sum()) / (pairs * variance))
    return np.array(found)


def _find_reach(cells: _Cells, residuals: Scalars) -> tuple[int, int]:
    values, there = _mean_errors(cells, residuals)
    return _reach_along(values, there), _reach_along(values.T, there.T)


def _reach_along(values: np.ndarray, there: np.ndarray) -> int:
    """Give the lag along the first axis from which on the values do not go together."""
    extent = len(values)
    most = min(_MOST_LAGS, max(int(_LARGEST_SHARE * extent), 1))
    variance = float((values**2).sum() / max(there.sum(), 1.0))
    quiet = 0
    for lag in range(1, most + 1):
        pairs = float((there[lag:] * there[:-lag]).sum()) if lag < extent else 0.0
        if pairs < 2 or variance == 0:
            return lag - quiet
        correlation = float((values[lag:] * values[:-lag]).sum()) / (pairs * variance)
        limit = _SIGNIFICANT * np.sqrt(np.log10(pairs) / pairs)
        quiet = quiet + 1 if abs(correlation) < limit else 0
        if quiet == _QUIET_LAGS:
            return lag - quiet + 1
    return most


def _sum_pairs(
    cells: _Cells, moments: Float[np.ndarray, "n p"], reach: tuple[int, int]
) -> Float[np.ndarray, "p p"]:
    """Sum the products of the moments of all pairs of points, less and less with their distance."""
    widths = [_WIDTH * r for r in reach]
    weights = [1 - np.abs(np.arange(-w + 1, w)) / w for w in widths]
    maps = [cells.fill(moment) for moment in moments.T]
    spread = [
        convolve1d(convolve1d(m, weights[0], axis=0, mode="constant"), weights[1], mode="constant")
        for m in maps
    ]
    return np.array([[float((m * s).sum()) for s in spread] for m in maps])


def _widen(cells: _Cells, reach: Sequence[float | int]) -> float:
    """Give the factor on a variance for sums that reach over much of the points.

    What is fitted away and what too few patches cannot show make such sums too small. The 97.5 %
    point of the statistic is a cubic of the sums' width over the extent.
    """
    share = max(min(_WIDTH * r / extent, 1.0) for r, extent in zip(reach, cells.shape, strict=True))
    share = min(share, 1.0)
    return ((1.96 + 2.9694 * share + 0.4160 * share**2 - 0.5324 * share**3) / 1.96) ** 2


def _at_least(
    matrix: Float[np.ndarray, "p p"], least: Float[np.ndarray, "p p"]
) -> Float[np.ndarray, "p p"]:
    """Raise a covariance, in each direction, to what another one has there."""
    # A direction without any errors has no root: it gets one that changes nothing elsewhere.
    slack = 1e-12 * float(np.diag(least).max()) + 1e-300
    root = np.linalg.cholesky(least + slack * np.eye(len(least)))
    inverse = np.linalg.inv(root)
    sizes, axes = np.linalg.eigh(inverse @ (matrix + matrix.T) @ inverse.T / 2)
    return root @ (axes * np.maximum(sizes, 1.0)) @ axes.T @ root.T
