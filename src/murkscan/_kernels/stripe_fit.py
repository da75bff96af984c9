"""A stripe with a core and a skirt on a curved background, fitted by maximum likelihood."""

import numpy as np

from .cholesky import first_variance, solve
from .compiled import loop, part

_SIZE = 7
"""Parameters: centre, height, log of the core's width, skirt's share, background, its slope, its
curvature."""
_MOST_STEPS = 8
_FEWEST = 6
"""Pixels that are not white, below which nothing is fitted."""
_GLARE = 8.0
"""White pixels, in widths of the core, from which a stripe is lost in glare."""


@loop()
def spread_skirts(
    levels: np.ndarray, lines: np.ndarray, starts: np.ndarray, half: int,
    along: float, across: float,
) -> np.ndarray:  # fmt: skip
    """Give the skirt in each start's window, from the light of all starts around (n size).

    Each sends a share of its light over a Gaussian of 1σ `along` its scan line [px] and `across`
    them [lines]; that of an even, straight stripe has a height of 1. Lines do not decrease.
    """
    size = 2 * half + 1
    skirts = np.zeros((len(lines), size))
    heights = np.empty(len(lines))
    for i in range(len(lines)):
        heights[i] = _rise(levels, lines[i], int(np.rint(starts[i])), half)
    reach = int(np.ceil(3.0 * across))
    weights, total = np.empty(reach + 1), 0.0
    for i in range(reach + 1):
        weights[i] = np.exp(-0.5 * (i / across) ** 2)
        total += weights[i]
    weights /= 2.0 * total - weights[0]
    first = 0
    for i in range(len(lines)):
        middle = int(np.rint(starts[i]))
        while lines[first] < lines[i] - reach:
            first += 1
        for j in range(first, len(lines)):
            if lines[j] > lines[i] + reach:
                break
            share = weights[abs(lines[j] - lines[i])] * heights[j] / heights[i]
            off = middle - half - starts[j]
            if abs(off + half) < half + 4.0 * along:
                _add_bell(skirts[i], share, off / along, 1.0 / along)
    return skirts


@part()
def _add_bell(profile: np.ndarray, height: float, first: float, step: float) -> None:
    """Add height · exp(-x² / 2) at x = first, first + step, …, by products alone."""
    value = height * np.exp(-0.5 * first * first)
    ratio = np.exp(-step * (first + 0.5 * step))
    change = np.exp(-step * step)
    for k in range(len(profile)):
        profile[k] += value
        value *= ratio
        ratio *= change


@part()
def _rise(levels: np.ndarray, line: int, middle: int, half: int) -> float:
    """Give how far a stripe's middle rises above its window's ends; at least one level."""
    last = len(levels) - 1
    top = 0.0
    for v in range(max(middle - 1, 0), min(middle + 1, last) + 1):
        top = max(top, float(levels[v, line]))
    low, high = max(middle - half, 0), min(middle + half, last)
    return max(top - 0.5 * (float(levels[low, line]) + float(levels[high, line])), 1.0)


@loop()
def fit_stripes(
    levels: np.ndarray, signal: np.ndarray, lines: np.ndarray, starts: np.ndarray,
    skirts: np.ndarray, noise: np.ndarray, shape: np.ndarray,
) -> np.ndarray:  # fmt: skip
    """Fit a stripe to each start, by Gauss and Newton's method with weights 1 / variance.

    `levels` are as recorded, `signal` without what is fixed to the picture. `noise` holds the
    variance's fixed part, its part per level and per level squared, its least, and white's level;
    `shape` the core's width [px] and its prior's spread (of the logarithm), the skirt's share of
    the height and its prior's spread; `skirts` its profile in each window.
    Gives centre, its standard deviation, height, core's width and skirt's share (n 5); NaN where
    none fits.
    """
    found = np.full((len(lines), 5), np.nan)
    p, step = np.empty(_SIZE), np.empty(_SIZE)
    matrix = np.empty((_SIZE, _SIZE))
    half = skirts.shape[1] // 2
    rows = np.empty((_SIZE + 1, 2 * half + 1))
    # Windows as numbers of one kind: what fits them is compiled once, whatever pictures are.
    raws, scans = np.empty(2 * half + 1), np.empty(2 * half + 1)
    for i in range(len(lines)):
        middle = int(np.rint(starts[i]))
        low, high = max(middle - half, 0), min(middle + half, len(levels) - 1)
        raw, scan, white = raws[: high - low + 1], scans[: high - low + 1], 0
        for v in range(len(raw)):
            raw[v], scan[v] = float(levels[low + v, lines[i]]), float(signal[low + v, lines[i]])
            white += raw[v] >= noise[4]
        skirt = skirts[i, low - middle + half : high - middle + half + 1]
        if white > _GLARE * shape[0] + 1.0:
            continue
        _begin(scan, middle - low, starts[i] - middle, shape, p)
        variance = -1.0
        for turn in range(_MOST_STEPS):
            is_enough = _normal_equations(
                raw, scan, skirt, middle - low, p, noise, shape, matrix, step, rows
            )
            if not is_enough or not solve(matrix, step):
                variance = -1.0
                break
            variance = 1.0
            _take_step(p, step)
            if abs(step[0]) < 1e-3 and turn > 1:
                break
        if variance > 0.0:
            variance = first_variance(matrix)
        if variance > 0.0 and abs(p[0]) < 2.0 + shape[0]:
            found[i, 0], found[i, 1], found[i, 2] = middle + p[0], np.sqrt(variance), p[1]
            found[i, 3], found[i, 4] = np.exp(p[2]), p[3]
    return found


@part()
def _begin(scan: np.ndarray, middle: int, off: float, shape: np.ndarray, p: np.ndarray) -> None:
    """Start with the background's straight line between the window's ends."""
    n = len(scan)
    left = 0.5 * (scan[0] + scan[1])
    right = 0.5 * (scan[n - 1] + scan[n - 2])
    slope = (right - left) / (n - 2)
    top = 0.0
    for v in range(max(middle - 1, 0), min(middle + 2, n)):
        top = max(top, scan[v])
    base = left + slope * (middle - 0.5)
    p[0], p[1], p[2], p[3] = off, max(top - base, 1.0), np.log(shape[0]), shape[2]
    p[4], p[5], p[6] = base, slope, 0.0


@part()
def _take_step(p: np.ndarray, step: np.ndarray) -> None:
    """Add the step, no longer than a fit can be trusted over."""
    step[0] = min(max(step[0], -0.5), 0.5)
    step[2] = min(max(step[2], -0.3), 0.3)
    for k in range(len(p)):
        p[k] += step[k]
    p[1] = max(p[1], 0.05)


@part()
def _dot(first: np.ndarray, second: np.ndarray, count: int) -> float:
    total = 0.0
    for v in range(count):
        total += first[v] * second[v]
    return total


@part(error_model="numpy")
def _normal_equations(
    raw: np.ndarray, scan: np.ndarray, skirt: np.ndarray, middle: int, p: np.ndarray,
    noise: np.ndarray, shape: np.ndarray, matrix: np.ndarray, right: np.ndarray, rows: np.ndarray,
) -> bool:  # fmt: skip
    """Fill the normal equations at p, with the priors; white pixels are left out.

    `rows` has room for each parameter's derivatives, and what the model misses, by pixel, divided
    by the noise. False where too few pixels are left.
    """
    width = np.exp(p[2])
    count = 0
    for v in range(len(scan)):
        level = scan[v]
        along = float(v - middle)
        x = (along - p[0]) / width
        core = np.exp(-0.5 * x * x)
        profile = core + p[3] * skirt[v]
        model = p[1] * profile + p[4] + p[5] * along + p[6] * along * along
        lit = min(max(model + raw[v] - level, 0.0), noise[4])
        root = 0.0
        if raw[v] < noise[4]:
            root = 1.0 / np.sqrt(max(noise[0] + lit * (noise[1] + lit * noise[2]), noise[3]))
            count += 1
        rows[0, v] = root * p[1] * core * x / width
        rows[1, v] = root * profile
        rows[2, v] = root * p[1] * core * x * x
        rows[3, v] = root * p[1] * skirt[v]
        rows[4, v], rows[5, v], rows[6, v] = root, root * along, root * along * along
        rows[7, v] = root * (level - model)
    for a in range(_SIZE):
        right[a] = _dot(rows[a], rows[7], len(scan))
        for b in range(a + 1):
            matrix[a, b] = _dot(rows[a], rows[b], len(scan))
    _add_priors(p, shape, matrix, right)
    return count >= _FEWEST


@part()
def _add_priors(p: np.ndarray, shape: np.ndarray, matrix: np.ndarray, right: np.ndarray) -> None:
    """Hold width and skirt near what was learnt, and let the background bend no more than a foot.

    The background's curvature over a core's width stays near a hundredth of the stripe's height.
    """
    curvature = 0.0025 * abs(p[1]) / shape[0] ** 2 + 1e-3
    for k, off, spread in (
        (2, np.log(shape[0]) - p[2], shape[1]),
        (3, shape[2] - p[3], shape[3]),
        (6, -p[6], curvature),
    ):
        matrix[k, k] += 1.0 / spread**2
        right[k] += off / spread**2
    for k in range(len(p)):
        matrix[k, k] *= 1.0 + 1e-9
