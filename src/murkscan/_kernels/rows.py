"""Noise that all pixels of a row have in common."""

import numpy as np

from .compiled import loop, part

HALF = 4
"""Rows on both sides that a row is compared with."""
_FEWEST = 16
"""Pixels whose mean is known to a quarter of their noise."""


@loop()
def row_offsets(levels: np.ndarray, bound: np.ndarray) -> np.ndarray:
    """Estimate by how much each row is brighter than those around it.

    The mean over its pixels of their difference to the mean of `HALF` rows on both sides. Those
    count that lie on no stripe: neither they nor those in the same column, as many rows away,
    differ by more than `bound` (one a row). Where a stripe stands along the row, its few gaps
    tell; where there are none, all pixels count, by no more than that.
    """
    length, width = levels.shape
    off, lit = _compare(levels, bound)
    offsets, near = np.zeros(length), np.zeros(width, np.int64)
    low, high = 0, 0
    for v in range(length):
        while high < min(v + HALF + 1, length):
            near += lit[high]
            high += 1
        while low < v - HALF:
            near -= lit[low]
            low += 1
        bounded, plain, count = 0.0, 0.0, 0
        for u in range(width):
            bounded += min(max(off[v, u], -bound[v]), bound[v])
            if near[u] == 0:
                plain += off[v, u]
                count += 1
        offsets[v] = plain / count if count >= _FEWEST else bounded / width
    return offsets


@part()
def _compare(levels: np.ndarray, bound: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Give each pixel's difference to the mean of its column around, and whether it is much."""
    length, width = levels.shape
    off, lit = np.empty((length, width), np.float32), np.empty((length, width), np.bool_)
    around = np.zeros(width)
    low, high = 0, 0
    for v in range(length):
        first, last = max(v - HALF, 0), min(v + HALF + 1, length)
        while high < last:
            for u in range(width):
                around[u] += levels[high, u]
            high += 1
        while low < first:
            for u in range(width):
                around[u] -= levels[low, u]
            low += 1
        share = 1.0 / (last - first)
        for u in range(width):
            off[v, u] = levels[v, u] - share * around[u]
            lit[v, u] = abs(off[v, u]) > bound[v]
    return off, lit
