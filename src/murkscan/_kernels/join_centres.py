"""Centres, joined with their neighbours over scan lines and frames to a bent surface."""

import numpy as np
from numba import njit

from .cholesky import first_variance, solve, substitute

_SIZE = 5
"""Parameters: centre, its slope over lines, its speed over frames, its curvature over both."""
_TURNS = 3
_MOST = 512
"""Neighbours of a centre that are looked at."""


@njit(cache=True, nogil=True)
def join_centres(
    lines: np.ndarray, times: np.ndarray, centres: np.ndarray, sigma: np.ndarray,
    common: np.ndarray, length: np.ndarray, rough: np.ndarray, starts: np.ndarray,
    first: int, last: int, reach: float,
) -> np.ndarray:  # fmt: skip
    """Give centres first … last and their standard deviations, joined with those around (n 2).

    `sigma` is what each centre errs by itself, or as those of `length` lines around do, `common`
    what all neighbours err by together, with its sign.

    All are sorted by frame, then by line; frame f has the centres starts[f] … starts[f + 1].
    Lines and times are counted in lines and frames. Neighbours lie up to `reach` lines away, in all
    frames given. A neighbour counts less with its own variance, with its distance, since surfaces
    are `rough` [px], and with the misfit of all beyond their noise.
    """
    joined = np.empty((last - first, 2))
    near = np.empty((_MOST, 7))
    for i in range(first, last):
        joined[i - first] = _join_one(
            i, lines, times, centres, sigma, common, length[i], starts, reach, rough[i], near
        )
    return joined


@njit(cache=True, nogil=True)
def _join_one(
    i: int, lines: np.ndarray, times: np.ndarray, centres: np.ndarray, sigma: np.ndarray,
    common: np.ndarray, length: float, starts: np.ndarray, reach: float, rough: float,
    near: np.ndarray,
) -> tuple[float, float]:  # fmt: skip
    count = _gather(i, lines, times, centres, sigma, common, starts, reach, rough, near)
    p = np.zeros(_SIZE)
    matrix, right, slopes = np.empty((_SIZE, _SIZE)), np.empty(_SIZE), np.empty(_SIZE)
    slopes[0] = 1.0
    variance, excess = sigma[i] ** 2 + common[i] ** 2, 0.0
    for turn in range(_TURNS):
        matrix[:] = 0.0
        right[:] = 0.0
        matrix[1, 1] = matrix[2, 2] = 1.0 / 0.3**2
        matrix[3, 3] = 1.0 / 0.02**2
        matrix[4, 4] = 1.0 / 0.03**2
        weights, misfits = 0.0, 0.0
        for k in range(count):
            along, later, off, noise, far, own, _ = near[k]
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
        together, alone = _weigh_errors(matrix, near[:count], p, excess)
        # What goes on over some lines is noise or the surface, and not both.
        variance = max(variance, min(length * alone, sigma[i] ** 2)) + together**2
        if turn == 1:
            excess = max(misfits / max(weights, 1.0), 0.0)
    return centres[i] + p[0], np.sqrt(variance)


@njit(cache=True, nogil=True)
def _weigh_errors(
    root: np.ndarray, near: np.ndarray, p: np.ndarray, excess: float
) -> tuple[float, float]:
    """Give by how much the joined centre errs where all neighbours err together by `common`.

    And the variance that their noise gives it where each errs by itself.
    """
    answer, slopes = np.zeros(_SIZE), np.empty(_SIZE)
    answer[0] = slopes[0] = 1.0
    substitute(root, answer)
    together, alone = 0.0, 0.0
    for k in range(len(near)):
        along, later, off, noise, far, own, common = near[k]
        slopes[1], slopes[2], slopes[3], slopes[4] = along, later, along * along, later * later
        miss, share = off, 0.0
        for a in range(_SIZE):
            miss -= p[a] * slopes[a]
            share += answer[a] * slopes[a]
        share /= noise + own + excess * far + 0.25 * miss * miss
        together += share * common
        alone += share * share * noise
    return together, alone


@njit(cache=True, nogil=True)
def _gather(
    i: int, lines: np.ndarray, times: np.ndarray, centres: np.ndarray, sigma: np.ndarray,
    common: np.ndarray, starts: np.ndarray, reach: float, rough: float, near: np.ndarray,
) -> int:  # fmt: skip
    """List what may be the same surface, and give how many there are.

    Each has its distance in lines and in frames, the difference of centres, its variance, its share
    of the misfit, what the surface's roughness adds, and what it errs by as others do.
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
            noise = sigma[j] ** 2 + common[j] ** 2
            bound = (
                3.0 * np.sqrt(noise + sigma[i] ** 2 + common[i] ** 2)
                + 0.3 * abs(along)
                + 0.4 * abs(later)
            )
            if abs(off) >= bound:
                continue
            far = 1.0 + (along * along + 4.0 * later * later) / 9.0
            near[count, 0], near[count, 1], near[count, 2] = along, later, off
            near[count, 3] = noise
            near[count, 4] = far if j != i else 0.0
            near[count, 5] = (rough * far) ** 2 if j != i else 0.0
            near[count, 6] = common[j]
            count += 1
    return count
