"""Stripes so bright that pixels are white: they have two edges and no peak."""

import numpy as np

from .compiled import loop, part

_RUNGS = 5
"""Levels at which the edges are looked for."""
_LOWEST, _HIGHEST = 0.45, 0.85
"""Shares of the rise from the surroundings to white between which these levels lie: below, the
skirt's sides differ; above, noise decides which pixels are white."""
_LEAST_RISE = 0.3
"""Share of white by which a plateau exceeds what is beside it: at 0.5, those beside glare on metal
are lost (one in a hundred of the pyramid's, benchmarks/real.py); at 0.15, papers in daylight are
found instead of the stripe."""
_FLANK = 12
"""Pixels within which a flank must sink to the lowest of them, and at least the plateau's width."""


@loop()
def find_plateaus(
    levels: np.ndarray, white: float, shortest: int, longest: int, most: int
) -> tuple[np.ndarray, np.ndarray]:
    """Find runs of white pixels in each column; dark gaps of one pixel are passed over.

    Gives the first and the last row of each (lines, most, 2), the longest kept, and how many a
    column has.
    """
    length, num_lines = levels.shape
    runs, counts = np.zeros((num_lines, most, 2)), np.zeros(num_lines, np.int64)
    first = np.full(num_lines, -1, np.int64)
    last = np.full(num_lines, -9, np.int64)
    for v in range(length + 2):
        for u in range(num_lines):
            is_white = v < length and levels[v, u] >= white
            if is_white:
                if first[u] < 0:
                    first[u] = v
                last[u] = v
            elif first[u] >= 0 and v - last[u] > 1:
                size = last[u] - first[u] + 1
                if shortest <= size <= longest and counts[u] < most:
                    runs[u, counts[u], 0], runs[u, counts[u], 1] = first[u], last[u]
                    counts[u] += 1
                first[u] = -1
    return runs, counts


@loop()
def measure_plateaus(
    levels: np.ndarray, lines: np.ndarray, starts: np.ndarray, law: np.ndarray
) -> np.ndarray:
    """Measure the middle between both edges of the run around each start, at several levels.

    `law` holds the variance's fixed part, its part per level and per level squared, its least, and
    white's level. Gives middle, its standard deviation, height above the surroundings and width
    between the edges (n 4); NaN where a side does not sink.
    """
    found = np.full((len(lines), 4), np.nan)
    middles = np.empty(_RUNGS)
    for i in range(len(lines)):
        column = levels[:, lines[i]]
        low, high = _grow(column, int(starts[i]), law[4])
        far = max(_FLANK, high - low + 1)
        left, right = _lowest(column, low, -1, far), _lowest(column, high, 1, far)
        base = max(left, right)
        rise = law[4] - base
        if rise < _LEAST_RISE * law[4]:
            continue
        total, width, steep = 0.0, 0.0, 0.0
        whole = True
        for k in range(_RUNGS):
            level = base + rise * (_LOWEST + (_HIGHEST - _LOWEST) * k / (_RUNGS - 1))
            a, slope_a = _cross(column, low, -1, level)
            b, slope_b = _cross(column, high, 1, level)
            if not (slope_a > 0.0 and slope_b > 0.0):
                whole = False
                break
            middles[k] = 0.5 * (a + b)
            total += middles[k]
            width += b - a
            lit = law[0] + level * (law[1] + level * law[2])
            steep += 0.25 * max(lit, law[3]) * (1.0 / slope_a**2 + 1.0 / slope_b**2)
        if not whole:
            continue
        mean = total / _RUNGS
        spread = 0.0
        for k in range(_RUNGS):
            spread += (middles[k] - mean) ** 2
        # Levels share pixels: two or so of five are of their own.
        variance = (steep / _RUNGS + spread / (_RUNGS - 1)) / 2.0
        found[i, 0], found[i, 1] = mean, np.sqrt(variance)
        found[i, 2], found[i, 3] = rise, width / _RUNGS
    return found


@part()
def _grow(column: np.ndarray, start: int, white: float) -> tuple[int, int]:
    """Find the first and the last white pixel around a start, over dark gaps of one pixel."""
    ends = [start, start]
    for side in range(2):
        way, v = 2 * side - 1, start
        while 0 <= v + way < len(column):
            if column[v + way] >= white:
                v += way
            elif 0 <= v + 2 * way < len(column) and column[v + 2 * way] >= white:
                v += 2 * way
            else:
                break
        ends[side] = v
    return ends[0], ends[1]


@part()
def _lowest(column: np.ndarray, start: int, way: int, far: int) -> float:
    """Find the lowest level on one side of a run."""
    lowest = float(column[start])
    for k in range(1, far + 1):
        v = start + way * k
        if v < 0 or v >= len(column):
            break
        lowest = min(lowest, float(column[v]))
    return lowest


@part()
def _cross(column: np.ndarray, start: int, way: int, level: float) -> tuple[float, float]:
    """Find where a flank sinks below a level, and how steep it is there; 0 where it does not."""
    v = start
    while 0 <= v + way < len(column):
        above, below = float(column[v]), float(column[v + way])
        if below < level:
            slope = above - below
            if slope <= 0.0:
                return float(v), 0.0
            return v + way * (above - level) / slope, slope
        v += way
    return float(v), 0.0
