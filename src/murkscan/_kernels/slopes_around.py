"""How a surface slants around a centre, over scan lines and over frames."""

import numpy as np

from .compiled import part

_AROUND, _STEEPEST = 4, 3.0
"""Scan lines to both sides by which it is told how a surface slants, and the most that it may [px a
line and a frame], as `extract.pull` has it."""


@part(error_model="numpy")
def measure_slopes(
    i: int, lines: np.ndarray, times: np.ndarray, centres: np.ndarray, starts: np.ndarray
) -> tuple[float, float]:  # fmt: skip
    """Measure how a surface goes on around a centre: by how much a line, and by how much a frame.

    What is no more than its scatter is left out: the join itself finds small slopes.
    """
    lean = 0.0
    for t in range(2):
        n, x, y, xx, xy, yy = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        for f in range(len(starts) - 1):
            if starts[f] == starts[f + 1] or abs(times[starts[f]] - times[i]) > t:
                continue
            reach = _AROUND - t * (_AROUND - 1)
            low = first_from(lines, starts[f], starts[f + 1], lines[i] - reach)
            for j in range(low, starts[f + 1]):
                along, later = lines[j] - lines[i], times[j] - times[i]
                if along > reach:
                    break
                off = centres[j] - centres[i]
                if abs(off) > _STEEPEST * (abs(along) + abs(later)):
                    continue
                at = later if t else along
                off -= t * lean * along
                n, x, y = n + 1.0, x + at, y + off
                xx, xy, yy = xx + at * at, xy + at * off, yy + off * off
        slope = _credible_slope(n, xx - x * x / n, xy - x * y / n, yy - y * y / n)
        if t == 0:
            lean = slope
    return lean, slope


@part(error_model="numpy")
def _credible_slope(n: float, xx: float, xy: float, yy: float) -> float:
    """Give a straight line's slope, shrunk by its own variance, from central sums of squares."""
    if n < 3.0 or xx <= 0.0 or xy == 0.0:
        return 0.0
    slope = xy / xx
    variance = max(yy - slope * xy, 0.0) / ((n - 2.0) * xx)
    return slope * max(1.0 - variance / slope**2, 0.0)


@part()
def first_from(lines: np.ndarray, low: int, high: int, least: float) -> int:
    """Find the first of the sorted lines low … high - 1 that is at least so large; else high."""
    while low < high:
        middle = (low + high) // 2
        if lines[middle] < least:
            low = middle + 1
        else:
            high = middle
    return low
