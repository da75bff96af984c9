"""The smallest of each pixel's levels over frames."""

import numpy as np

from .compiled import loop

_TILE = 512
"""Pixels that are looked at together: those of fifty frames stay in the fastest memory."""


@loop()
def find_smallest(stack: np.ndarray, rank: int) -> np.ndarray:
    """Find for each pixel the level that `rank` of its levels come before (frames, pixels).

    From the highest bit down: it is set where no more than `rank` levels are below what it gives.
    """
    count, size = stack.shape
    found = np.zeros(size, stack.dtype)
    wanted, below = np.empty(_TILE, stack.dtype), np.empty(_TILE, np.int16)
    for start in range(0, size, _TILE):
        width = min(_TILE, size - start)
        best = found[start : start + width]
        for bit in range(8 * stack.itemsize - 1, -1, -1):
            for u in range(width):
                wanted[u] = best[u] | (1 << bit)
                below[u] = 0
            for i in range(count):
                levels = stack[i, start : start + width]
                for u in range(width):
                    below[u] += levels[u] < wanted[u]
            for u in range(width):
                if below[u] <= rank:
                    best[u] = wanted[u]
    return found


@loop()
def sum_smallest(stack: np.ndarray, number: int, largest: np.ndarray) -> np.ndarray:
    """Sum each pixel's `number` smallest levels, whose largest is known."""
    count, size = stack.shape
    total = np.empty(size, np.int64)
    for u in range(size):
        total[u] = (number - count) * np.int64(largest[u])
    for i in range(count):
        for u in range(size):
            total[u] += min(stack[i, u], largest[u])
    return total
