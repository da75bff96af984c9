"""How a stripe slants, and how its light changes, around each of its centres."""

import numpy as np

from .cholesky import first_variance, solve
from .compiled import loop, part

_FAR, _NEAR = 6, 3
"""Scan lines on both sides from which the slope, and the change of light, are told."""
_GAP, _INNER = 2, 4
"""Scan lines without a centre beyond which a stripe has ended, and those further in that say how
bright it is."""
_BEND = 0.25
"""Spread of the second derivative of the light's logarithm [1/line²]: beyond a stripe's end, light
that the lens blurs by w falls as its Gaussian's integral, which bends by 0.64 / w² there."""


@loop()
def measure_slants(
    lines: np.ndarray, centres: np.ndarray, logs: np.ndarray, sigma: np.ndarray, step: float
) -> np.ndarray:
    """Measure slope and change of light around each centre, and how dark it is (n 5).

    Lines do not decrease. `logs` are logarithms of the stripe's light with standard deviations
    `sigma`; `step` is the most by which a surface's centre differs from that of the scan line
    beside it. Gives pixels a line, e-folds a line, and the standard deviation of the latter, which
    is 0, as the change is, where no neighbour tells; and by how many e-folds the last centre before
    a gap is darker than those further in, 0 elsewhere; and by how many each is darker than what is
    brightest on either side of it, 0 where it is not.
    """
    found = np.zeros((len(lines), 5))
    near = np.empty(2 * _FAR + 1, np.int64)
    for i in range(len(lines)):
        count = _follow(i, lines, centres, step, near)
        found[i, 0] = _fit_slope(i, lines, centres, near[:count])
        found[i, 1], found[i, 2] = _fit_change(i, lines, logs, sigma, near[:count])
        found[i, 3] = _darken(i, lines, logs, near[:count])
        found[i, 4] = _dip(i, lines, logs, near[:count])
    return found


@part()
def _dip(i: int, lines: np.ndarray, logs: np.ndarray, near: np.ndarray) -> float:
    """Give by how much the brightest on the darker side exceeds a centre; 0 where it does not."""
    before, after = -np.inf, -np.inf
    for j in near:
        if lines[j] < lines[i]:
            before = max(before, logs[j])
        elif lines[j] > lines[i]:
            after = max(after, logs[j])
    return max(min(before, after) - logs[i], 0.0)


@part()
def _darken(i: int, lines: np.ndarray, logs: np.ndarray, near: np.ndarray) -> float:
    """Give by how much the brightest of the lines further in exceeds an end; 0: it is none."""
    dark = 0.0
    for way in (-1, 1):
        is_end, count, top = True, 0, -np.inf
        for j in near:
            along = way * (lines[j] - lines[i])
            if 0 < along <= _GAP:
                is_end = False
            if -_INNER <= along < 0:
                count += 1
                top = max(top, logs[j])
        if is_end and count >= _GAP:
            dark = max(dark, top - logs[i])
    return dark


@part()
def _follow(i: int, lines: np.ndarray, centres: np.ndarray, step: float, near: np.ndarray) -> int:
    """List the centres of the same surface around one, itself among them; give their number."""
    near[0] = i
    count = 1
    for way in (-1, 1):
        last, j = i, i + way
        while 0 <= j < len(lines) and abs(lines[j] - lines[i]) <= _FAR:
            line, best = lines[j], -1
            while 0 <= j < len(lines) and lines[j] == line:
                if best < 0 or abs(centres[j] - centres[last]) < abs(centres[best] - centres[last]):
                    best = j
                j += way
            if line == lines[i]:
                continue
            if abs(centres[best] - centres[last]) > step * abs(line - lines[last]):
                break
            near[count] = best
            count += 1
            last = best
    return count


@part()
def _fit_slope(i: int, lines: np.ndarray, values: np.ndarray, near: np.ndarray) -> float:
    """Fit a straight line; give its slope."""
    n, x, y, xx, xy = 0.0, 0.0, 0.0, 0.0, 0.0
    for j in near:
        along, off = float(lines[j] - lines[i]), values[j] - values[i]
        n, x, y, xx, xy = n + 1.0, x + along, y + off, xx + along * along, xy + along * off
    spread = xx - x * x / n
    return (xy - x * y / n) / spread if spread > 0.0 else 0.0


@part()
def _fit_change(
    i: int, lines: np.ndarray, logs: np.ndarray, sigma: np.ndarray, near: np.ndarray
) -> tuple[float, float]:
    """Fit a parabola; give its slope at centre i and the standard deviation of that."""
    matrix, right, slopes = np.zeros((3, 3)), np.zeros(3), np.empty(3)
    count = 0
    for j in near:
        slopes[0], slopes[1] = float(lines[j] - lines[i]), 1.0
        slopes[2] = 0.5 * slopes[0] ** 2
        if abs(slopes[0]) > _NEAR:
            continue
        count += 1
        weight = 1.0 / (sigma[j] ** 2 + 1e-6)
        for a in range(3):
            right[a] += weight * slopes[a] * (logs[j] - logs[i])
            for b in range(a + 1):
                matrix[a, b] += weight * slopes[a] * slopes[b]
    matrix[2, 2] += 1.0 / _BEND**2
    if count < 2 or not solve(matrix, right):
        return 0.0, 0.0
    return right[0], np.sqrt(first_variance(matrix))
