"""Noise that all pixels of a row have in common."""

import numpy as np
from numba import njit

HALF = 4
"""Rows on both sides that a row is compared with."""


@njit(cache=True, nogil=True)
def row_offsets(levels: np.ndarray, bound: np.ndarray) -> np.ndarray:
    """Estimate by how much each row is brighter than those around it.

    The mean over its pixels of their difference to the mean of `HALF` rows on both sides, none by
    more than `bound` (one a row): a stripe along the row counts no more.
    """
    length, width = levels.shape
    offsets = np.zeros(length)
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
        total, share, most = 0.0, 1.0 / (last - first), bound[v]
        for u in range(width):
            total += min(max(levels[v, u] - share * around[u], -most), most)
        offsets[v] = total / width
    return offsets
