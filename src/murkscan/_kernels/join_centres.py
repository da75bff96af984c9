"""Centres, joined with their neighbours over scan lines and frames to a bent surface."""

import numpy as np
from numba import njit

from .cholesky import first_variance, solve

_SIZE = 5
"""Parameters: centre, its slope over lines, its speed over frames, its curvature over both."""
_TURNS = 3
_MOST = 512
"""Neighbours of a centre that are looked at."""


@njit(cache=True, nogil=True)
def join_centres(
    lines: np.ndarray, times: np.ndarray, centres: np.ndarray, sigma: np.ndarray,
    starts: np.ndarray, first: int, last: int, reach: float, rough: float,
) -> np.ndarray:  # fmt: skip
    """Give centres first … last and their standard deviations, joined with those around (n 2).

    All are sorted by frame, then by line; frame f has the centres starts[f] … starts[f + 1].
    Lines and times are counted in lines and frames. Neighbours lie up to `reach` lines away, in all
    frames given. A neighbour counts less with its own variance, with its distance, since surfaces
    are rough (`rough` [px]), and with the misfit of all beyond their noise.
    """
    joined = np.empty((last - first, 2))
    near = np.empty((_MOST, 6))
    for i in range(first, last):
        joined[i - first] = _join_one(i, lines, times, centres, sigma, starts, reach, rough, near)
    return joined


@njit(cache=True, nogil=True)
def _join_one(
    i: int, lines: np.ndarray, times: np.ndarray, centres: np.ndarray, sigma: np.ndarray,
    starts: np.ndarray, reach: float, rough: float, near: np.ndarray,
) -> tuple[float, float]:  # fmt: skip
    count = _gather(i, lines, times, centres, sigma, starts, reach, rough, near)
    p = np.zeros(_SIZE)
    matrix, right, slopes = np.empty((_SIZE, _SIZE)), np.empty(_SIZE), np.empty(_SIZE)
    slopes[0] = 1.0
    variance, excess = sigma[i] ** 2, 0.0
    for turn in range(_TURNS):
        matrix[:] = 0.0
        right[:] = 0.0
        matrix[1, 1] = matrix[2, 2] = 1.0 / 0.3**2
        matrix[3, 3] = 1.0 / 0.02**2
        matrix[4, 4] = 1.0 / 0.03**2
        weights, misfits = 0.0, 0.0
        for k in range(count):
            along, later, off, noise, far, own = near[k]
            spread = noise + own + excess * far
            slopes[1], slopes[2] = along, later
            slopes[3], slopes[4] = along * along, later * later
            bent = p[3] * slopes[3] + p[4] * slopes[4]
            miss = off - (p[0] + p[1] * along + p[2] * later + bent)
            robust = 1.0 + miss * miss / (4.0 * spread) if turn else 1.0
            weight = 1.0 / (spread * robust)
            for a in range(_SIZE):
                right[a] += weight * off * slopes[a]
                for b in range(a + 1):
                    matrix[a, b] += weight * slopes[a] * slopes[b]
            weights += 1.0 / robust
            misfits += min(miss * miss - noise, 9.0 * noise + 1.0) / robust
        if not solve(matrix, right):
            break
        p[:] = right
        variance = first_variance(matrix)
        if turn == 1:
            excess = max(misfits / max(weights, 1.0), 0.0)
    return centres[i] + p[0], np.sqrt(variance)


@njit(cache=True, nogil=True)
def _gather(
    i: int, lines: np.ndarray, times: np.ndarray, centres: np.ndarray, sigma: np.ndarray,
    starts: np.ndarray, reach: float, rough: float, near: np.ndarray,
) -> int:  # fmt: skip
    """List what may be the same surface, and give how many there are.

    Each has its distance in lines and in frames, the difference of centres, its variance, its share
    of the misfit, and what the surface's roughness adds.
    """
    count = 0
    for f in range(len(starts) - 1):
        low = starts[f] + np.searchsorted(lines[starts[f] : starts[f + 1]], lines[i] - reach)
        for j in range(low, starts[f + 1]):
            along = lines[j] - lines[i]
            if along > reach or count == len(near):
                break
            later = times[j] - times[i]
            off = centres[j] - centres[i]
            noise = sigma[j] ** 2
            bound = 3.0 * np.sqrt(noise + sigma[i] ** 2) + 0.3 * abs(along) + 0.4 * abs(later)
            if abs(off) >= bound:
                continue
            far = 1.0 + (along * along + 4.0 * later * later) / 9.0
            near[count, 0], near[count, 1], near[count, 2] = along, later, off
            near[count, 3] = noise
            near[count, 4] = far if j != i else 0.0
            near[count, 5] = (rough * far) ** 2 if j != i else 0.0
            count += 1
    return count
