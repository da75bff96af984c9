"""Zhang-Suen thinning by a list of the pixels whose neighbourhood has changed."""

import numpy as np

from .compiled import loop


def _deletion_tables() -> np.ndarray:
    """Which neighbourhoods lose their pixel, for both sub-iterations (2 256).

    Bit k of a neighbourhood is the paper's P(k+1): north first, then clockwise.
    """
    tables = np.zeros((2, 256), np.bool_)
    for code in range(256):
        p = [code >> k & 1 for k in range(8)]
        north, east, south, west = p[0], p[2], p[4], p[6]
        rises = sum(p[k] == 0 and p[(k + 1) % 8] == 1 for k in range(8))
        if 2 <= sum(p) <= 6 and rises == 1:
            tables[0, code] = not (north and east and south) and not (east and south and west)
            tables[1, code] = not (north and east and west) and not (north and south and west)
    return tables


_TABLES = _deletion_tables()


@loop()
def _thin(flat: np.ndarray, width: int, start: np.ndarray, tables: np.ndarray) -> None:
    """Thin a flat image whose outermost pixels are never looked at, in place.

    Whether a pixel goes depends on its neighbourhood alone, so only pixels whose neighbourhood has
    changed since the same sub-iteration saw them last are looked at again: bit k of `waiting` says
    that a pixel stands in the list of sub-iteration k.
    """
    steps = np.array([-width, 1 - width, 1, width + 1, width, width - 1, -1, -width - 1])
    waiting = np.full(len(flat), 3, np.uint8)
    lists = np.empty((2, 2, len(start)), np.int64)
    counts = np.zeros((2, 2), np.int64)
    doomed = np.empty(len(start), np.int64)
    for k in range(2):
        for i in range(len(start)):
            lists[k, 0, i] = start[i]
        counts[k, 0] = len(start)
    turn = np.zeros(2, np.int64)
    while counts[0, turn[0]] > 0 or counts[1, turn[1]] > 0:
        for k in range(2):
            now = turn[k]
            turn[k] = 1 - now
            counts[k, 1 - now] = 0
            num_doomed = 0
            for n in range(counts[k, now]):
                i = lists[k, now, n]
                waiting[i] &= ~np.uint8(1 << k)
                if flat[i]:
                    code = 0
                    for b in range(8):
                        code |= int(flat[i + steps[b]]) << b
                    if tables[k, code]:
                        doomed[num_doomed] = i
                        num_doomed += 1
            for n in range(num_doomed):
                flat[doomed[n]] = False
            for n in range(num_doomed):
                for b in range(8):
                    j = doomed[n] + steps[b]
                    if flat[j]:
                        for other in range(2):
                            bit = np.uint8(1 << other)
                            if not waiting[j] & bit:
                                waiting[j] |= bit
                                lists[other, turn[other], counts[other, turn[other]]] = j
                                counts[other, turn[other]] += 1


def thin_zhang_suen(binary: np.ndarray) -> np.ndarray:
    """Thin a boolean image (h w) to a skeleton one pixel wide; the outermost pixels stay."""
    thinned = np.ascontiguousarray(binary).copy()
    height, width = binary.shape
    if height < 3 or width < 3:
        return thinned
    inner = np.flatnonzero(thinned[1:-1, 1:-1])
    start = (inner // (width - 2) + 1) * width + inner % (width - 2) + 1
    _thin(thinned.reshape(-1), width, start, _TABLES)
    return thinned
