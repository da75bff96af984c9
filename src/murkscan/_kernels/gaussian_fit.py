"""Gaussians on a sloping background, fitted to peaks."""

import numpy as np

from .cholesky import solve
from .compiled import loop, part

_SIZE = 5
"""Parameters: height, centre, width, background, its slope."""
_ITERATIONS = 25
_NARROWEST, _WIDEST = 0.4, 3.0
"""Widths that are stripes: from less than a pixel to this many times the window."""


@part()
def _normal_equations(
    scan: np.ndarray, low: int, high: int, p: np.ndarray, full: float,
    matrix: np.ndarray, right: np.ndarray,
) -> float:  # fmt: skip
    """Fill the normal equations at p; gives the sum of squares. Saturated pixels are left out."""
    matrix[:] = 0.0
    right[:] = 0.0
    slopes = np.empty(_SIZE)
    total = 0.0
    for v in range(low, high):
        if scan[v] >= full:
            continue
        t = (v - p[1]) / p[2]
        bell = np.exp(-0.5 * t * t)
        slopes[0], slopes[3], slopes[4] = bell, 1.0, (v - low) - 0.5 * (high - low)
        slopes[1], slopes[2] = p[0] * bell * t / p[2], p[0] * bell * t * t / p[2]
        off = scan[v] - (p[0] * bell + p[3] + p[4] * slopes[4])
        total += off * off
        for i in range(_SIZE):
            right[i] += slopes[i] * off
            for j in range(i + 1):
                matrix[i, j] += slopes[i] * slopes[j]
    return total


@part()
def _fill_damped(work: np.ndarray, matrix: np.ndarray, damped: float) -> None:
    """Copy a matrix by its lower half, its diagonal times a factor."""
    for i in range(_SIZE):
        for j in range(i):
            work[i, j] = matrix[i, j]
        work[i, i] = damped * matrix[i, i]


@loop()
def fit_peaks(
    image: np.ndarray, peaks: np.ndarray, down: bool, half_width: int, noise: float, full: float
) -> np.ndarray:
    """Fit a Gaussian to each peak, by Levenberg and Marquardt's method.

    Gives centre, its standard deviation, height, one peak a row (n 3); NaN where none fits.
    `full` is the level from which a pixel is saturated.
    """
    found = np.full((len(peaks), 3), np.nan)
    matrix, right = np.empty((_SIZE, _SIZE)), np.empty(_SIZE)
    trial, step = np.empty(_SIZE), np.empty(_SIZE)
    work = np.empty((_SIZE, _SIZE))
    for i in range(len(peaks)):
        line, peak = peaks[i]
        scan = image[:, line] if down else image[line]
        low, high = max(peak - half_width, 0), min(peak + half_width + 1, len(scan))
        base = 0.5 * (scan[low] + scan[high - 1])
        p = np.array([scan[peak] - base, float(peak), half_width / 4.0, base, 0.0])
        damping = 1e-2
        total = _normal_equations(scan, low, high, p, full, matrix, right)
        done = False
        for _ in range(_ITERATIONS):
            for k in range(_SIZE):
                step[k] = right[k]
            _fill_damped(work, matrix, 1.0 + damping)
            if not solve(work, step):
                break
            for k in range(_SIZE):
                trial[k] = p[k] + step[k]
            if trial[2] > _NARROWEST / 2 and abs(trial[1] - peak) <= half_width:
                new = _normal_equations(scan, low, high, trial, full, matrix, right)
                if new <= total:
                    done = abs(step[1]) < 1e-5
                    p, trial, total = trial, p, new
                    damping *= 0.2
                    if done:
                        break
                    continue
            damping *= 10.0
            _normal_equations(scan, low, high, p, full, matrix, right)
        _fill_damped(work, matrix, 1.0)
        step[:] = 0.0
        step[1] = 1.0
        good = _NARROWEST <= p[2] <= _WIDEST * half_width and p[0] > 0 and damping < 1e6
        if good and solve(work, step):
            found[i, 0], found[i, 1], found[i, 2] = p[1], noise * np.sqrt(step[1]), p[0]
    return found
