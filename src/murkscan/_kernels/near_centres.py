"""The centres around one, in scan lines and frames, that may be of the same surface."""

import numpy as np

from .compiled import part


@part()
def gather_near(
    i: int, lines: np.ndarray, times: np.ndarray, centres: np.ndarray, noise: np.ndarray,
    roots: np.ndarray, common: np.ndarray, drawn: np.ndarray, starts: np.ndarray, reach: float,
    rough: float, near: np.ndarray,
) -> int:  # fmt: skip
    """List what may be the same surface, and give how many there are.

    Each has its distance in lines and in frames, the difference of centres, its variance, its share
    of the misfit, what the surface's roughness adds, what it errs by as others do: all, and those
    of its scan line, and the root of its variance.
    """
    count = 0
    for f in range(len(starts) - 1):
        low = _first_from(lines, starts[f], starts[f + 1], lines[i] - reach)
        for j in range(low, starts[f + 1]):
            along = lines[j] - lines[i]
            if along > reach or count == near.shape[1]:
                break
            later = times[j] - times[i]
            off = centres[j] - centres[i]
            beyond = abs(off) - 0.3 * abs(along) - 0.4 * abs(later)
            if beyond > 0.0 and beyond * beyond >= 9.0 * (noise[j] + noise[i]):
                continue
            far = 1.0 + (along * along + 4.0 * later * later) / 9.0
            near[0, count], near[1, count], near[2, count] = along, later, off
            near[3, count] = noise[j]
            near[4, count] = far if j != i else 0.0
            near[5, count] = (rough * far) ** 2 if j != i else 0.0
            near[6, count] = common[j]
            near[7, count] = drawn[j]
            near[8, count] = roots[j]
            count += 1
    return count


@part()
def _first_from(lines: np.ndarray, low: int, high: int, least: float) -> int:
    """Find the first of the sorted lines low … high - 1 that is at least so large; else high."""
    while low < high:
        middle = (low + high) // 2
        if lines[middle] < least:
            low = middle + 1
        else:
            high = middle
    return low
