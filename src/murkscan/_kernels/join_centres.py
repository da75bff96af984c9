"""Centres, joined with their neighbours over scan lines and frames to a bent surface."""

import numpy as np

from .cholesky import first_variance, solve, substitute
from .compiled import loop, part

_SIZE = 5
"""Parameters: centre, its slope over lines, its speed over frames, its curvature over both."""
_TURNS = 3
_MOST, _COLUMNS = 512, 7
"""Neighbours of a centre that are looked at, and what is known of each."""


@loop()
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
    noise = sigma**2 + common**2
    near = np.empty((_COLUMNS, _MOST))
    for i in range(first, last):
        count = _gather(i, lines, times, centres, noise, common, starts, reach, rough[i], near)
        off, joined[i - first, 1] = _join_one(near, count, sigma[i] ** 2, noise[i], length[i])
        joined[i - first, 0] = centres[i] + off
    return joined


@part()
def _join_one(
    near: np.ndarray, count: int, own: float, variance: float, length: float
) -> tuple[float, float]:
    """Put a bent surface through one centre's neighbours; give by how much it is off, and 1σ.

    `own` is the variance that the centre has by itself, `variance` with what all err by together.
    """
    p = np.zeros(_SIZE)
    matrix, right = np.empty((_SIZE, _SIZE)), np.empty(_SIZE)
    excess = 0.0
    for turn in range(_TURNS):
        mean = _normal_equations(near, count, p, excess, 0.25 if turn else 0.0, matrix, right)
        if not solve(matrix, right):
            break
        for k in range(_SIZE):
            p[k] = right[k]
        variance = first_variance(matrix)
        together, alone = _weigh_errors(matrix, near, count, p, excess)
        # What goes on over some lines is noise or the surface, and not both.
        variance = max(variance, min(length * alone, own)) + together**2
        if turn == 1:
            excess = max(mean, 0.0)
    return p[0], np.sqrt(variance)


@part(error_model="numpy")
def _normal_equations(
    near: np.ndarray, count: int, p: np.ndarray, excess: float, robust: float,
    matrix: np.ndarray, right: np.ndarray,
) -> float:  # fmt: skip
    """Fill the normal equations of the surface, with the priors; give the mean misfit.

    They are sums of products of distances in lines (a) and frames (t): each is made once, and all
    at a time. Misfits count with `robust` times their square in the variance.
    """
    along, later, off, noise, far, own = near[0], near[1], near[2], near[3], near[4], near[5]
    n, a1, a2, a3, a4, t1, t2, t3, t4 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    at, aat, att, aatt, y, ay, ty, aay, tty = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    weights, misfits = 0.0, 0.0
    p0, p1, p2, p3, p4 = p[0], p[1], p[2], p[3], p[4]
    for k in range(count):
        a, t = along[k], later[k]
        aa, tt = a * a, t * t
        spread = noise[k] + own[k] + excess * far[k]
        miss = off[k] - (p0 + p1 * a + p2 * t + p3 * aa + p4 * tt)
        square = miss * miss
        w = 1.0 / (spread + robust * square)
        more, most = square - noise[k], 9.0 * noise[k] + 1.0
        weights += spread * w
        misfits += (more if more < most else most) * spread * w
        wa, wt, waa, wtt, wy = w * a, w * t, w * aa, w * tt, w * off[k]
        n, a1, t1, a2, t2, at = n + w, a1 + wa, t1 + wt, a2 + waa, t2 + wtt, at + wa * t
        a3, t3, a4, t4 = a3 + waa * a, t3 + wtt * t, a4 + waa * aa, t4 + wtt * tt
        aat, att, aatt = aat + waa * t, att + wa * tt, aatt + waa * tt
        y, ay, ty, aay, tty = y + wy, ay + wy * a, ty + wy * t, aay + wy * aa, tty + wy * tt
    right[0], right[1], right[2], right[3], right[4] = y, ay, ty, aay, tty
    matrix[0, 0], matrix[1, 0], matrix[1, 1] = n, a1, a2 + 1.0 / 0.3**2
    matrix[2, 0], matrix[2, 1], matrix[2, 2] = t1, at, t2 + 1.0 / 0.3**2
    matrix[3, 0], matrix[3, 1], matrix[3, 2], matrix[3, 3] = a2, a3, aat, a4 + 1.0 / 0.02**2
    matrix[4, 0], matrix[4, 1], matrix[4, 2], matrix[4, 3] = t2, att, t3, aatt
    matrix[4, 4] = t4 + 1.0 / 0.03**2
    return misfits / max(weights, 1.0)


@part(error_model="numpy")
def _weigh_errors(
    root: np.ndarray, near: np.ndarray, count: int, p: np.ndarray, excess: float
) -> tuple[float, float]:
    """Give by how much the joined centre errs where all neighbours err together by `common`.

    And the variance that their noise gives it where each errs by itself.
    """
    answer = np.zeros(_SIZE)
    answer[0] = 1.0
    substitute(root, answer)
    along, later, off, noise, far, own = near[0], near[1], near[2], near[3], near[4], near[5]
    common = near[6]
    p0, p1, p2, p3, p4 = p[0], p[1], p[2], p[3], p[4]
    b0, b1, b2, b3, b4 = answer[0], answer[1], answer[2], answer[3], answer[4]
    together, alone = 0.0, 0.0
    for k in range(count):
        a, t = along[k], later[k]
        aa, tt = a * a, t * t
        miss = off[k] - (p0 + p1 * a + p2 * t + p3 * aa + p4 * tt)
        share = b0 + b1 * a + b2 * t + b3 * aa + b4 * tt
        share /= noise[k] + own[k] + excess * far[k] + 0.25 * miss * miss
        together += share * common[k]
        alone += share * share * noise[k]
    return together, alone


@part()
def _gather(
    i: int, lines: np.ndarray, times: np.ndarray, centres: np.ndarray, noise: np.ndarray,
    common: np.ndarray, starts: np.ndarray, reach: float, rough: float, near: np.ndarray,
) -> int:  # fmt: skip
    """List what may be the same surface, and give how many there are.

    Each has its distance in lines and in frames, the difference of centres, its variance, its share
    of the misfit, what the surface's roughness adds, and what it errs by as others do.
    """
    count = 0
    for f in range(len(starts) - 1):
        low = _first_from(lines, starts[f], starts[f + 1], lines[i] - reach)
        for j in range(low, starts[f + 1]):
            along = lines[j] - lines[i]
            if along > reach or count == near.shape[1]:
                break
            later = times[j] - times[i]
            off = centres[j] - centres[i]
            bound = 3.0 * np.sqrt(noise[j] + noise[i]) + 0.3 * abs(along) + 0.4 * abs(later)
            if abs(off) >= bound:
                continue
            far = 1.0 + (along * along + 4.0 * later * later) / 9.0
            near[0, count], near[1, count], near[2, count] = along, later, off
            near[3, count] = noise[j]
            near[4, count] = far if j != i else 0.0
            near[5, count] = (rough * far) ** 2 if j != i else 0.0
            near[6, count] = common[j]
            count += 1
    return count


@part()
def _first_from(lines: np.ndarray, low: int, high: int, least: float) -> int:
    """Find the first of the sorted lines low … high - 1 that is at least so large; else high."""
    while low < high:
        middle = (low + high) // 2
        if lines[middle] < least:
            low = middle + 1
        else:
            high = middle
    return low
