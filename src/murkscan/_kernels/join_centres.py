"""Centres, joined with their neighbours over scan lines and frames to a bent surface."""

import numpy as np

from .cholesky import first_variance, solve, substitute
from .compiled import loop, part
from .near_centres import gather_near

_SIZE = 5
"""Parameters: centre, its slope over lines, its speed over frames, its curvature over both."""
_TURNS = 3
_MOST, _COLUMNS = 512, 12
"""Neighbours of a centre that are looked at, and what is known of each; three more are for sums."""
_BESIDE, _ALL, _OWN = 2.0, 8.0, 0.7
"""1σ of the Gaussians by which scan lines count, where it is measured how far the surface is off:
those around a centre, and its own [lines]."""
_TOLD = 2.0
"""Times that a square exceeds its own variance, to tell anything; what is more is shrunk by it."""
_BEND, _BENT = 0.03, 1.0
"""Curvature over frames that surfaces have at least by chance, and that is asked for first [px per
frame²]. One that is held tighter than it is draws balls inwards: of 40 mm, 0.9 m before a PAL rig,
they bend by .005 to .08 at 1 to 4 mm a frame, and at 60 degrees by eight times as much."""
_ONE_WAY = 3.0
"""Scan lines that are drawn one way by what darkens the stripe unevenly."""

_SUMS = 6
_TOTAL, _SQUARES, _PULL = 0, 1, 2
_WEIGHTS, _PAIRS, _MISSES, _TWICE, _ROOTS, _DRAWN = 0, 1, 2, 3, 4, 5
"""What is summed up over the frames of each scan line: by `_weigh_errors` and `_sum_misfits`."""


@loop()
def join_centres(
    lines: np.ndarray, times: np.ndarray, centres: np.ndarray, sigma: np.ndarray,
    common: np.ndarray, drawn: np.ndarray, rough: np.ndarray, starts: np.ndarray, first: int,
    last: int, reach: float, length: float, alone: float, same: float, seen: float,
) -> np.ndarray:  # fmt: skip
    """Give centres first … last and their standard deviations, joined with those around (n 2).

    `sigma` is what each centre errs by itself, or as those of `length` lines around do. Of its
    square, a share `alone` is its frame's own, and a share `same` errs alike in all frames;
    `seen` is the share that frames have in common, be it by error or as the surface is rough.
    `common` is what all neighbours err by together, with its sign; by `drawn`, all frames err
    alike, and a few scan lines.

    All are sorted by frame, then by line; frame f has the centres starts[f] … starts[f + 1].
    Lines and times are counted in lines and frames. Neighbours lie up to `reach` lines away, in all
    frames given. A neighbour counts less with its own variance, with its distance, since surfaces
    are `rough` [px], and with the misfit of all beyond their noise.
    """
    joined = np.empty((last - first, 2))
    noise = sigma**2 + common**2 + drawn**2
    roots, near = np.sqrt(noise), np.empty((_COLUMNS, _MOST))
    sums = np.empty((_SUMS, 2 * int(reach) + 1))
    bells = _draw_bells(sums.shape[1])
    for i in range(first, last):
        count = gather_near(
            i, lines, times, centres, noise, roots, common, drawn, starts, reach, rough[i], near
        )
        off, joined[i - first, 1] = _join_one(
            near, count, sigma[i] ** 2, drawn[i] ** 2, noise[i], length, alone, same, seen, sums,
            bells,
        )  # fmt: skip
        joined[i - first, 0] = centres[i] + off
    return joined


@part()
def _join_one(
    near: np.ndarray, count: int, own: float, drawn: float, variance: float, length: float,
    alone: float, same: float, seen: float, sums: np.ndarray, bells: np.ndarray,
) -> tuple[float, float]:  # fmt: skip
    """Put a bent surface through one centre's neighbours; give by how much it is off, and 1σ.

    `own` is the variance that the centre has by itself, `drawn` what uneven light adds to it, and
    `variance` that of all.
    """
    p = np.zeros(_SIZE)
    matrix, right = np.empty((_SIZE, _SIZE)), np.empty(_SIZE)
    excess, held = 0.0, _BENT**-2
    for turn in range(_TURNS):
        robust = 0.25 if turn else 0.0
        mean = _normal_equations(near, count, p, excess, robust, held, matrix, right)
        if not solve(matrix, right):
            return p[0], np.sqrt(variance)
        for k in range(_SIZE):
            p[k] = right[k]
        if turn < _TURNS - 1:
            held = _hold_bend(p[4], matrix[4, 4], held, length)
        if turn == 1:
            excess = max(mean, 0.0)
    together = _weigh_errors(matrix, near, count, p, excess, sums)
    known, pull = 0.0, 0.0
    for b in range(sums.shape[1]):
        known += alone * sums[_SQUARES, b] + same * sums[_TOTAL, b] ** 2
        pull += sums[_PULL, b] ** 2
    known = min(length * known, (alone + same) * own) + min(_ONE_WAY * pull, drawn)
    # What goes on over some lines is noise or the surface, and not both.
    known = max(first_variance(matrix), known)
    if not _sum_misfits(near, count, p, sums):
        return p[0], np.sqrt(known + together**2)
    misfit = max(
        _measure_misfit(sums, seen, variance, bells[0]),
        _measure_misfit(sums, seen, variance, bells[1]),
    )
    off, unsure = _measure_own(sums, alone + same - seen, same, bells[2])
    share = misfit / (misfit + unsure)
    return p[0] + share * off, np.sqrt((1.0 - share**2) * known + share * unsure + together**2)


@part(error_model="numpy")
def _hold_bend(bend: float, root: float, held: float, length: float) -> float:
    """Give the inverse variance by which a window's own curvature over frames is held to 0.

    How much surfaces bend is a matter of place: it is that by which the window's centres are
    likeliest, the square of what they show less its variance (empirical Bayes), where it tells.

    Args:
        bend: The curvature that was found [px per frame²].
        root: Its element on the diagonal of the equations' root.
        held: How it was held then.
        length: Scan lines over which errors are alike: so many neighbours tell as much as one.
    """
    told = root**2 - held
    if told < 1e-3 * held:
        return _BEND**-2
    shown = bend * root**2 / told
    return 1.0 / max(shown**2 - _TOLD * length / told, _BEND**2)


@part(error_model="numpy")
def _normal_equations(
    near: np.ndarray, count: int, p: np.ndarray, excess: float, robust: float, held: float,
    matrix: np.ndarray, right: np.ndarray,
) -> float:  # fmt: skip
    """Fill the normal equations of the surface, with the priors; give the mean misfit.

    They are sums of products of distances in lines (a) and frames (t): each is made once, and all
    at a time. Misfits count with `robust` times their square in the variance. The curvature over
    frames is held to 0 by the inverse variance `held`.
    """
    along, later, off, noise, far, own = near[0], near[1], near[2], near[3], near[4], near[5]
    n, a1, a2, a3, a4, t1, t2, t3, t4 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    at, aat, att, aatt, y, ay, ty, aay, tty = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    weights, misfits = 0.0, 0.0
    counts, shares, excesses = near[9], near[10], near[11]
    p0, p1, p2, p3, p4 = p[0], p[1], p[2], p[3], p[4]
    for k in range(count):  # without sums: several at once
        a, t = along[k], later[k]
        spread = noise[k] + own[k] + excess * far[k]
        miss = off[k] - (p0 + p1 * a + p2 * t + p3 * a * a + p4 * t * t)
        square = miss * miss
        counts[k] = 1.0 / (spread + robust * square)
        more, most = square - noise[k], 9.0 * noise[k] + 1.0
        excesses[k] = (more if more < most else most) * spread * counts[k]
        shares[k] = spread * counts[k]
    for k in range(count):
        a, t, w = along[k], later[k], counts[k]
        aa, tt = a * a, t * t
        weights += shares[k]
        misfits += excesses[k]
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
    matrix[4, 4] = t4 + held
    return misfits / max(weights, 1.0)


@part(error_model="numpy")
def _weigh_errors(
    root: np.ndarray, near: np.ndarray, count: int, p: np.ndarray, excess: float, sums: np.ndarray
) -> float:  # fmt: skip
    """Give by how much the joined centre errs where all neighbours err together by `common`.

    And sum up, by scan line, what the error of each neighbour by 1σ adds, and the squares of that.
    """
    answer = np.zeros(_SIZE)
    answer[0] = 1.0
    substitute(root, answer)
    along, later, off, noise, far, own = near[0], near[1], near[2], near[3], near[4], near[5]
    common, drawn, roots, shares = near[6], near[7], near[8], near[9]
    p0, p1, p2, p3, p4 = p[0], p[1], p[2], p[3], p[4]
    b0, b1, b2, b3, b4 = answer[0], answer[1], answer[2], answer[3], answer[4]
    together, middle = 0.0, sums.shape[1] // 2
    sums[:] = 0.0
    for k in range(count):
        a, t = along[k], later[k]
        aa, tt = a * a, t * t
        miss = off[k] - (p0 + p1 * a + p2 * t + p3 * aa + p4 * tt)
        share = b0 + b1 * a + b2 * t + b3 * aa + b4 * tt
        shares[k] = share / (noise[k] + own[k] + excess * far[k] + 0.25 * miss * miss)
    for k in range(count):
        together += shares[k] * common[k]
        error = shares[k] * roots[k]
        b = middle + int(np.rint(along[k]))
        sums[_TOTAL, b] += error
        sums[_SQUARES, b] += error * error
        sums[_PULL, b] += shares[k] * drawn[k]
    return together


@part(error_model="numpy")
def _sum_misfits(near: np.ndarray, count: int, p: np.ndarray, sums: np.ndarray) -> bool:
    """Sum up by scan line what the surface misses; tell whether any line has several frames."""
    along, later, off, noise, drawn = near[0], near[1], near[2], near[3], near[7]
    roots, misses = near[8], near[9]
    p0, p1, p2, p3, p4 = p[0], p[1], p[2], p[3], p[4]
    middle, shows = sums.shape[1] // 2, False
    for k in range(count):
        a, t = along[k], later[k]
        misses[k] = (off[k] - (p0 + p1 * a + p2 * t + p3 * a * a + p4 * t * t)) / noise[k]
    sums[:] = 0.0
    for k in range(count):
        root, miss = 1.0 / roots[k], misses[k]
        weight = root * root
        b = middle + int(np.rint(along[k]))
        shows |= sums[_WEIGHTS, b] > 0.0
        sums[_WEIGHTS, b] += weight
        sums[_PAIRS, b] += weight * weight
        sums[_MISSES, b] += miss
        sums[_TWICE, b] += miss * miss
        sums[_ROOTS, b] += root
        sums[_DRAWN, b] += weight * drawn[k]
    return shows


@part()
def _draw_bells(size: int) -> np.ndarray:
    """Give how much each scan line counts where it is measured how far the surface is off."""
    bells = np.empty((3, size))
    for row, reach in enumerate((_BESIDE, _ALL, _OWN)):
        for b in range(size):
            bells[row, b] = np.exp(-0.5 * ((b - size // 2) / reach) ** 2)
    return bells


@part(error_model="numpy")
def _measure_own(
    sums: np.ndarray, alone: float, same: float, bell: np.ndarray
) -> tuple[float, float]:
    """Give by how much the surface is off in its own scan line, and the variance of that.

    A share `alone` of each centre's variance is noise of its frame, a share `same` of all frames.
    """
    off, total, noise, pull = 0.0, 0.0, 0.0, 0.0
    for b in range(sums.shape[1]):
        near = bell[b]
        weight = sums[_WEIGHTS, b]
        off += near * sums[_MISSES, b]
        total += near * weight
        noise += near * near * (alone * weight + same * sums[_ROOTS, b] ** 2)
        pull += near * sums[_DRAWN, b]
    return off / total, (noise + pull**2) / total**2


@part(error_model="numpy")
def _measure_misfit(sums: np.ndarray, seen: float, own: float, bell: np.ndarray) -> float:
    """Measure the variance that frames have in common beside noise that is alike in them.

    It is the mean product of what the surface misses in one frame and in another, with 0 for one
    pair as sure as the centre itself, of a variance `own`: far lines alone tell nothing.
    """
    products, pairs, noise = 0.0, 2.0 / own**2, 0.0
    for b in range(sums.shape[1]):
        near = bell[b]
        weight = sums[_WEIGHTS, b]
        expected = seen * (sums[_ROOTS, b] ** 2 - weight) + sums[_DRAWN, b] ** 2
        products += near * (sums[_MISSES, b] ** 2 - sums[_TWICE, b] - expected)
        several = weight**2 - sums[_PAIRS, b]
        pairs += near * several
        noise += 2.0 * near * near * several
    if products <= 0.0:
        return 0.0
    return products / pairs * max(1.0 - _TOLD * noise / products**2, 0.0)
