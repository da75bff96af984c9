"""Ridges by Steger's method, at given peaks."""

import numpy as np
from numba import njit

from .gray_gravity import side_level

_MOVES = 4
"""Pixels that a peak may be moved along its scan line until the ridge lies within it."""


@njit(cache=True, nogil=True)
def find_ridges(
    image: np.ndarray, peaks: np.ndarray, down: bool, derivatives: np.ndarray, noise: float
) -> np.ndarray:
    """Find where the ridge of the smoothed picture crosses the scan line of each peak.

    `derivatives` holds the Gaussian derivatives x, y, xx, xy, yy as windows (5 h h).

    Gives centre, its standard deviation, height above what lies beyond the window, one peak a row
    (n 3); NaN where there is no ridge, or it runs along the scan line.
    """
    found = np.full((len(peaks), 3), np.nan)
    height, width = image.shape
    radius = derivatives.shape[1] // 2
    size = 2 * radius + 1
    r = np.empty(5)
    for i in range(len(peaks)):
        line, position = peaks[i]
        for _ in range(_MOVES):
            u, v = (line, position) if down else (position, line)
            r[:] = 0.0
            for j in range(size):
                row = image[min(max(v + j - radius, 0), height - 1)]
                for k in range(size):
                    level = float(row[min(max(u + k - radius, 0), width - 1)])
                    for d in range(5):
                        r[d] += derivatives[d, j, k] * level
            # The direction across the ridge: the Hessian's eigenvector of the most negative value.
            half, gap = 0.5 * (r[2] + r[4]), 0.5 * (r[2] - r[4])
            curve = half - np.hypot(gap, r[3])
            if curve >= 0:
                break
            nx, ny = curve - r[4], r[3]
            if abs(r[2] - curve) > abs(r[4] - curve):
                nx, ny = r[3], curve - r[2]
            length = np.hypot(nx, ny)
            if length == 0:
                break
            nx, ny = nx / length, ny / length
            across = ny if down else nx
            if abs(across) < 0.2:
                break
            offset = -(r[0] * nx + r[1] * ny) / (curve * across)
            if abs(offset) <= 0.6:
                total = 0.0
                for j in range(size):
                    for k in range(size):
                        total += (nx * derivatives[0, j, k] + ny * derivatives[1, j, k]) ** 2
                found[i, 0] = position + offset
                found[i, 1] = noise * np.sqrt(total) / abs(curve * across)
                scan = image[:, line] if down else image[line]
                left, _ = side_level(scan, position, -1, size // 2)
                right, _ = side_level(scan, position, 1, size // 2)
                found[i, 2] = scan[position] - 0.5 * (left + right)
                break
            position += int(np.rint(min(max(offset, -2.0), 2.0)))
            if not 0 <= position < (height if down else width):
                break
    return found
