"""The triangulation of a closed line of points that has the least area."""

import numpy as np

from .compiled import loop, part

_FLAT = 1e-4
"""Area of a triangle, in squares over its longest side, below which it has no normal."""


@loop(error_model="numpy")
def least_area(points: np.ndarray, is_barred: np.ndarray) -> np.ndarray:
    """Cover a closed line by triangles between its points, of least area and none of them a line.

    Args:
        points: The line's corners in order [m], n × 3, n at least 3.
        is_barred: Which pairs of corners no new side may join, n × n.

    Returns:
        Three corners a triangle, in the line's own sense, (n - 2) × 3; none where the bars leave no
        triangulation.

    References:
        Barequet and Sharir, Filling gaps in the boundary of a polyhedron, Computer Aided Geometric
        Design 12, 1995, section 3.
    """
    n = len(points)
    cost = np.zeros((n, n))
    split = np.zeros((n, n), np.int64)
    for width in range(2, n):
        for i in range(n - width):
            j = i + width
            cost[i, j] = np.inf
            if is_barred[i, j] and width < n - 1:
                continue
            for k in range(i + 1, j):
                whole = cost[i, k] + cost[k, j]
                if whole < cost[i, j]:
                    whole += _price(points, i, k, j)
                    if whole < cost[i, j]:
                        cost[i, j] = whole
                        split[i, j] = k
    if not np.isfinite(cost[0, n - 1]):
        return np.zeros((0, 3), np.int64)
    return _collect(split, n)


@part(error_model="numpy")
def _price(points: np.ndarray, i: int, j: int, k: int) -> float:
    """Give a triangle's area; one that is hardly more than a line costs as much as a square."""
    ux, vx = points[j, 0] - points[i, 0], points[k, 0] - points[i, 0]
    uy, vy = points[j, 1] - points[i, 1], points[k, 1] - points[i, 1]
    uz, vz = points[j, 2] - points[i, 2], points[k, 2] - points[i, 2]
    x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    area = 0.5 * np.sqrt(x * x + y * y + z * z)
    longest = max(ux * ux + uy * uy + uz * uz, vx * vx + vy * vy + vz * vz)
    return area if area > _FLAT * longest else longest


@part(error_model="numpy")
def _collect(split: np.ndarray, n: int) -> np.ndarray:
    """Follow the splits from the whole line down to single triangles."""
    triangles = np.empty((n - 2, 3), np.int64)
    waiting = np.empty((n, 2), np.int64)
    waiting[0, 0], waiting[0, 1] = 0, n - 1
    left, made = 1, 0
    while left:
        left -= 1
        i, j = waiting[left]
        if j - i < 2:
            continue
        k = split[i, j]
        triangles[made, 0], triangles[made, 1], triangles[made, 2] = i, k, j
        made += 1
        waiting[left, 0], waiting[left, 1] = i, k
        waiting[left + 1, 0], waiting[left + 1, 1] = k, j
        left += 2
    return triangles
