"""The nearest place of many triangles, by a tree of boxes."""

import numpy as np

from .compiled import loop, part

_LEAF = 4
"""Triangles of one leaf, at most."""
_THIN = 1e-20
"""Square of the sine between two sides below which a triangle is a line: its sides tell all."""
_DEEPEST = 64
"""Levels of a tree: those of more triangles than fit into any memory."""


@loop(error_model="numpy")
def count_levels(count: int) -> int:
    """Give how often triangles are halved until a leaf holds the rest."""
    levels = 0
    while count > _LEAF << levels:
        levels += 1
    return levels


@loop(error_model="numpy")
def sort_triangles(middles: np.ndarray) -> np.ndarray:
    """Order triangles so that halves of halves lie together, each cut across its longest side.

    Node k of level l holds the places k·n/2^l to (k + 1)·n/2^l of that order, rounded down.

    Args:
        middles: Their middles [m], n × 3.
    """
    n = len(middles)
    order = np.arange(n)
    for level in range(count_levels(n)):
        for k in range(1 << level):
            start, stop = k * n >> level, (k + 1) * n >> level
            mine = order[start:stop].copy()
            widest, longest = 0, -1.0
            for axis in range(3):
                low, high = np.inf, -np.inf
                for i in range(start, stop):
                    value = middles[order[i], axis]
                    low, high = min(low, value), max(high, value)
                side = high - low
                if side > longest:
                    widest, longest = axis, side
            sorting = np.argsort(middles[mine, widest])
            for i in range(stop - start):  # an array that is set by another compiles for 2 s
                order[start + i] = mine[sorting[i]]
    return order


@loop(error_model="numpy")
def bound_nodes(triangles: np.ndarray) -> np.ndarray:
    """Give each node's box.

    Args:
        triangles: Corners [m] in the order of `sort_triangles`, n × 3 × 3.

    Returns:
        Lowest and highest coordinates [m], nodes × 2 × 3; node i has the nodes 2i + 1 and 2i + 2.
    """
    n = len(triangles)
    levels = count_levels(n)
    boxes = np.empty(((2 << levels) - 1, 2, 3))
    first = (1 << levels) - 1
    for k in range(1 << levels):
        start, stop = k * n >> levels, (k + 1) * n >> levels
        for axis in range(3):
            low, high = np.inf, -np.inf
            for i in range(start, stop):
                for corner in range(3):
                    value = triangles[i, corner, axis]
                    low, high = min(low, value), max(high, value)
            boxes[first + k, 0, axis], boxes[first + k, 1, axis] = low, high
    for node in range(first - 1, -1, -1):
        for axis in range(3):
            boxes[node, 0, axis] = min(boxes[2 * node + 1, 0, axis], boxes[2 * node + 2, 0, axis])
            boxes[node, 1, axis] = max(boxes[2 * node + 1, 1, axis], boxes[2 * node + 2, 1, axis])
    return boxes


@loop(error_model="numpy")
def find_nearest(
    points: np.ndarray, triangles: np.ndarray, boxes: np.ndarray, within: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Find which triangle is nearest to each point, and where.

    Args:
        points: The points [m], n × 3.
        triangles: Corners [m] in the order of `sort_triangles`, m × 3 × 3.
        boxes: Those of `bound_nodes`.
        within: Distance from which on none is looked for [m].

    Returns:
        The triangles' numbers, -1 where there is none; the weights of their corners at the nearest
        place, n × 3; and its distance [m], infinite where there is none.

    References:
        Ericson, Real-Time Collision Detection, 2005, sections 5.1.3, 5.1.5 and 6.2.
    """
    n = len(points)
    face, weights, away = np.full(n, -1), np.zeros((n, 3)), np.full(n, np.inf)
    for i in range(n):
        face[i], square = _search(points[i], triangles, boxes, within * within, weights[i])
        if face[i] >= 0:
            away[i] = np.sqrt(square)
    return face, weights, away


@part(error_model="numpy")
def _search(
    point: np.ndarray, triangles: np.ndarray, boxes: np.ndarray, best: float, weights: np.ndarray
) -> tuple[int, float]:
    """Give the triangle nearer than `best` and its squared distance; the nearer box goes first."""
    m, levels, face = len(triangles), count_levels(len(triangles)), -1
    first = (1 << levels) - 1
    waiting, squares = np.empty(_DEEPEST, np.int64), np.empty(_DEEPEST)
    waiting[0], squares[0], left = 0, _square_to_box(point, boxes[0]), 1
    tried = np.empty(3)
    while left:
        left -= 1
        node = waiting[left]
        if not squares[left] < best:
            continue
        if node < first:
            one, other = 2 * node + 1, 2 * node + 2
            to_one, to_other = (
                _square_to_box(point, boxes[one]),
                _square_to_box(point, boxes[other]),
            )
            if to_one > to_other:
                one, other, to_one, to_other = other, one, to_other, to_one
            waiting[left], squares[left] = other, to_other
            waiting[left + 1], squares[left + 1] = one, to_one
            left += 2
            continue
        k = node - first
        for j in range(k * m >> levels, (k + 1) * m >> levels):
            square = _square_to_triangle(point, triangles[j], tried)
            if square < best:
                best, face = square, j
                for i in range(3):
                    weights[i] = tried[i]
    return face, best


@part(error_model="numpy")
def _square_to_box(point: np.ndarray, box: np.ndarray) -> float:
    square = 0.0
    for axis in range(3):
        off = max(box[0, axis] - point[axis], point[axis] - box[1, axis], 0.0)
        square += off * off
    return square


@part(error_model="numpy")
def _square_to_triangle(point: np.ndarray, triangle: np.ndarray, weight: np.ndarray) -> float:
    """Give the squared distance, and write the corners' weights at the nearest place."""
    best = _square_to_inside(point, triangle, weight)
    if best >= 0:
        return best
    best = np.inf
    for corner in range(3):
        after = (corner + 1) % 3
        share, square = _on_side(point, triangle[corner], triangle[after])
        if square < best:
            best = square
            weight[:] = 0.0
            weight[corner], weight[after] = 1 - share, share
    return best


@part(error_model="numpy")
def _square_to_inside(point: np.ndarray, triangle: np.ndarray, weight: np.ndarray) -> float:
    """Write the weights of the perpendicular's foot; a negative distance where it lies outside."""
    a, b, c = triangle[0], triangle[1], triangle[2]
    ux, uy, uz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    vx, vy, vz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    px, py, pz = point[0] - a[0], point[1] - a[1], point[2] - a[2]
    nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    whole = nx * nx + ny * ny + nz * nz
    if not whole > _THIN * (ux * ux + uy * uy + uz * uz) * (vx * vx + vy * vy + vz * vz):
        return -1.0
    of_b = nx * (py * vz - pz * vy) + ny * (pz * vx - px * vz) + nz * (px * vy - py * vx)
    of_c = nx * (uy * pz - uz * py) + ny * (uz * px - ux * pz) + nz * (ux * py - uy * px)
    weight[1], weight[2] = of_b / whole, of_c / whole
    weight[0] = 1 - weight[1] - weight[2]
    if weight[0] <= 0 or weight[1] <= 0 or weight[2] <= 0:
        return -1.0
    return (px * nx + py * ny + pz * nz) ** 2 / whole


@part(error_model="numpy")
def _on_side(point: np.ndarray, a: np.ndarray, b: np.ndarray) -> tuple[float, float]:
    """Give how far along a side its nearest place lies, from 0 to 1, and its squared distance."""
    along = length = 0.0
    for axis in range(3):
        along += (point[axis] - a[axis]) * (b[axis] - a[axis])
        length += (b[axis] - a[axis]) ** 2
    share = min(max(along / length, 0.0), 1.0) if length > 0 else 0.0
    square = 0.0
    for axis in range(3):
        off = point[axis] - a[axis] - share * (b[axis] - a[axis])
        square += off * off
    return share, square
