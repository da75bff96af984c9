"""Centres, joined with their neighbours over scan lines and frames to a bent surface."""

import numpy as np
from numba import njit

from .cholesky import first_variance, solve

_SIZE = 4
"""Parameters: centre, its slope over lines, its speed over frames, its curvature over lines."""
_TURNS = 3


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
    for i in range(first, last):
        joined[i - first] = _join_one(i, lines, times, centres, sigma, starts, reach, rough)
    return joined


@njit(cache=True, nogil=True)
def _join_one(
    i: int, lines: np.ndarray, times: np.ndarray, centres: np.ndarray, sigma: np.ndarray,
    starts: np.ndarray, reach: float, rough: float,
) -> tuple[float, float]:  # fmt: skip
    p = np.zeros(_SIZE)
    matrix, right, slopes = np.empty((_SIZE, _SIZE)), np.empty(_SIZE), np.empty(_SIZE)
    variance, excess = sigma[i] ** 2, 0.0
    for turn in range(_TURNS):
        matrix[:] = 0.0
        right[:] = 0.0
        matrix[1, 1] = matrix[2, 2] = 1.0 / 0.3**2
        matrix[3, 3] = 1.0 / 0.02**2
        weights, misfits = 0.0, 0.0
        for f in range(len(starts) - 1):
            low = starts[f] + np.searchsorted(lines[starts[f] : starts[f + 1]], lines[i] - reach)
            for j in range(low, starts[f + 1]):
                along = lines[j] - lines[i]
                if along > reach:
                    break
                later = times[j] - times[i]
                off = centres[j] - centres[i]
                noise = sigma[j] ** 2
                bound = 3.0 * np.sqrt(noise + sigma[i] ** 2) + 0.3 * abs(along) + 0.4 * abs(later)
                if abs(off) >= bound:
                    continue
                far = (along * along + 4.0 * later * later) / 9.0
                spread = noise
                if j != i:
                    spread += (rough * (1.0 + far)) ** 2 + excess * (1.0 + far)
                slopes[0], slopes[1], slopes[2], slopes[3] = 1.0, along, later, along * along
                miss = off - (p[0] + p[1] * along + p[2] * later + p[3] * slopes[3])
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
