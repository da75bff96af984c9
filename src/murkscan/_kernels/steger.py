"""Ridges by Steger's method, at given peaks."""

import numpy as np

from .compiled import loop, part
from .gray_gravity import side_level

_MOVES = 4
"""Pixels that a peak may be moved along its scan line until the ridge lies within it."""
_STEEP = 0.2
"""Cosine to the scan line below which a ridge runs along it and does not cross."""
_WITHIN = 0.6
"""How far from its pixel's middle the ridge may lie [px]: a little more than half."""


@part()
def _respond(image: np.ndarray, u: int, v: int, derivatives: np.ndarray, r: np.ndarray) -> None:
    """Fill r with the derivatives x, y, xx, xy, yy of the smoothed picture at a pixel."""
    height, width = image.shape
    size = derivatives.shape[1]
    r[:] = 0.0
    for j in range(size):
        row = image[min(max(v + j - size // 2, 0), height - 1)]
        for k in range(size):
            level = float(row[min(max(u + k - size // 2, 0), width - 1)])
            for d in range(5):
                r[d] += derivatives[d, j, k] * level


@part()
def _across(r: np.ndarray) -> tuple[float, float, float]:
    """Most negative curvature, and the unit vector across the ridge; 0 where there is no ridge."""
    half, gap = 0.5 * (r[2] + r[4]), 0.5 * (r[2] - r[4])
    curve = half - np.hypot(gap, r[3])
    nx, ny = curve - r[4], r[3]
    if abs(r[2] - curve) > abs(r[4] - curve):
        nx, ny = r[3], curve - r[2]
    length = np.hypot(nx, ny)
    if curve >= 0 or length == 0:
        return 0.0, 0.0, 0.0
    return curve, nx / length, ny / length


@loop()
def find_ridges(
    image: np.ndarray, peaks: np.ndarray, down: bool, derivatives: np.ndarray, noise: float
) -> np.ndarray:
    """Find where the ridge of the smoothed picture crosses the scan line of each peak.

    `derivatives` holds the Gaussian derivatives x, y, xx, xy, yy as windows (5 h h).

    Gives centre, its standard deviation, height above what lies beyond the window, one peak a row
    (n 3); NaN where there is no ridge, or it runs along the scan line.
    """
    found = np.full((len(peaks), 3), np.nan)
    radius = derivatives.shape[1] // 2
    r = np.empty(5)
    for i in range(len(peaks)):
        line, position = peaks[i]
        scan = image[:, line] if down else image[line]
        for _ in range(_MOVES):
            u, v = (line, position) if down else (position, line)
            _respond(image, u, v, derivatives, r)
            curve, nx, ny = _across(r)
            across = ny if down else nx
            if abs(across) < _STEEP:
                break
            offset = -(r[0] * nx + r[1] * ny) / (curve * across)
            if abs(offset) <= _WITHIN:
                slope = nx * derivatives[0] + ny * derivatives[1]
                left, _ = side_level(scan, position, -1, radius)
                right, _ = side_level(scan, position, 1, radius)
                found[i, 0] = position + offset
                found[i, 1] = noise * np.sqrt(np.sum(slope**2)) / abs(curve * across)
                found[i, 2] = scan[position] - 0.5 * (left + right)
                break
            position += int(np.rint(min(max(offset, -2.0), 2.0)))
            if not 0 <= position < len(scan):
                break
    return found
