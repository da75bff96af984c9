"""Where a tile lies best in another relief, and how sure that is along each axis."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.ndimage import label

_SCORE = 0.5
"""Correlation below which nothing has been found."""
_CLEARER = 0.12
"""By how much the second best must lie below the best."""
_SIGMA_ASIDE = 0.35
"""Least standard deviation of a found place, in pixels of a relief's image."""


@dataclass(frozen=True, eq=False)
class Peak:
    """Where scores are best, in pixels."""

    place: Float[np.ndarray, "2"]
    spread: Float[np.ndarray, "2 2"]
    """Covariance."""


def find_peak(scores: Float[np.ndarray, "h w"], count: int) -> Peak | None:
    """Find the best place to a fraction of a pixel; None where it is not clear or at the rim.

    Args:
        scores: Correlations.
        count: Pixels of the tile.
    """
    if not np.isfinite(scores).any():
        return None
    i, j = np.unravel_index(int(np.nanargmax(scores)), scores.shape)
    best = float(scores[i, j])
    if best < _SCORE or not (0 < i < scores.shape[0] - 1 and 0 < j < scores.shape[1] - 1):
        return None
    near = np.zeros(scores.shape, bool)
    near[max(i - 3, 0) : i + 4, max(j - 3, 0) : j + 4] = True
    as_good, _ = label(scores > best - _CLEARER)
    # What goes on from the best place without a break is a seam, not another place.
    mine = as_good == as_good[i, j]
    if (as_good[~(near | mine)] > 0).any():
        return None
    around = scores[i - 1 : i + 2, j - 1 : j + 2]
    if not np.isfinite(around).all():
        return None
    off = np.array([_vertex(*around[:, 1]), _vertex(*around[1])])
    near = (near | mine) & np.isfinite(scores)
    away = np.argwhere(near) - (np.array([i, j]) + off)
    return Peak(np.array([i, j]) + off, _spread(away, scores[near], count))


def _spread(
    away: Float[np.ndarray, "n 2"], scores: Float[np.ndarray, " n"], count: int
) -> Float[np.ndarray, "2 2"]:
    """Compute the covariance of a place from how good the places about it are.

    Of n pixels with normal noise the likelihood of a place is (1 - ρ²)^(-n/2). That takes the tile
    for exact: its own noise and that of what it is laid on meet by chance, which by itself changes
    the logarithm by some √n from one place to the next (a facet makes four pixels, so that they err
    together), and this is what counts as one.
    """
    fit = -np.sqrt(count) / 2 * np.log1p(-(np.clip(scores, 0.0, 0.999) ** 2))
    weights = np.exp(fit - fit.max())
    spread = np.einsum("n,ni,nj->ij", weights / weights.sum(), away, away)
    return np.asarray(spread + _SIGMA_ASIDE**2 * np.eye(2))


def _vertex(before: float, here: float, after: float) -> float:
    """Give where the parabola through three scores is highest."""
    bend = before - 2 * here + after
    return 0.0 if bend >= 0 else float(np.clip(0.5 * (before - after) / bend, -0.5, 0.5))
