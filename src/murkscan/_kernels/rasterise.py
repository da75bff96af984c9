"""What of a surface is seen along parallel lines of sight: a z-buffer, one sample a cell."""

import math

import numpy as np

from .compiled import loop, part

_EDGE = 1e-7
"""Samples by which a triangle's rows reach beyond its edges, so that neighbours leave no crack."""


@loop(error_model="numpy")
def cover_with_triangles(
    points: np.ndarray, faces: np.ndarray, depth: np.ndarray, owner: np.ndarray
) -> None:
    """Find the nearest triangle in each sample.

    Each row of samples that a triangle crosses is filled between the triangle's edges, at the
    depth of its plane.

    Args:
        points: Corners in samples, u v and depth, f8, n × 3.
        faces: Their numbers, m × 3.
        depth: Nearest depth of each sample, f4, h × w; inf where there is nothing yet.
        owner: Triangle that lies there, i4, h × w.
    """
    height, width = depth.shape
    us, vs, zs = np.empty(3), np.empty(3), np.empty(3)
    for f in range(len(faces)):
        for k in range(3):
            us[k], vs[k], zs[k] = points[faces[f, k]]
        area = (us[1] - us[0]) * (vs[2] - vs[0]) - (vs[1] - vs[0]) * (us[2] - us[0])
        if area == 0.0:
            continue
        nearest = min(zs[0], zs[1], zs[2])
        farthest = max(zs[0], zs[1], zs[2])
        along_u = ((zs[1] - zs[0]) * (vs[2] - vs[0]) - (zs[2] - zs[0]) * (vs[1] - vs[0])) / area
        along_v = ((zs[2] - zs[0]) * (us[1] - us[0]) - (zs[1] - zs[0]) * (us[2] - us[0])) / area
        top = max(math.ceil(min(vs[0], vs[1], vs[2]) - _EDGE), 0)
        bottom = min(math.floor(max(vs[0], vs[1], vs[2]) + _EDGE), height - 1)
        for row in range(top, bottom + 1):
            left, right = _crossing(us, vs, row)
            first, last = max(math.ceil(left - _EDGE), 0), min(math.floor(right + _EDGE), width - 1)
            start = zs[0] + along_v * (row - vs[0]) - along_u * us[0]
            for column in range(first, last + 1):
                # A triangle seen from its edge has no slope to speak of.
                z = np.float32(min(max(start + along_u * column, nearest), farthest))
                if z < depth[row, column]:
                    depth[row, column] = z
                    owner[row, column] = f


@part(error_model="numpy")
def _crossing(us: np.ndarray, vs: np.ndarray, row: int) -> tuple[float, float]:
    """Find between which columns a row crosses a triangle."""
    left, right = np.inf, -np.inf
    for k in range(3):
        u, v, next_u, next_v = us[k], vs[k], us[(k + 1) % 3], vs[(k + 1) % 3]
        low, high = min(v, next_v), max(v, next_v)
        if low - _EDGE > row or high + _EDGE < row:
            continue
        if high - low < _EDGE:
            left, right = min(left, u, next_u), max(right, u, next_u)
            continue
        share = min(max((row - v) / (next_v - v), 0.0), 1.0)
        at = u + share * (next_u - u)
        left, right = min(left, at), max(right, at)
    return left, right


@loop(error_model="numpy")
def cover_with_discs(points: np.ndarray, radius: int, depth: np.ndarray, owner: np.ndarray) -> None:
    """Find the nearest point's disc in each sample.

    Args:
        points: Middles in samples, u v and depth, f8, n × 3.
        radius: Of each disc [samples].
        depth: Nearest depth of each sample, f4, h × w; inf where there is nothing yet.
        owner: Point whose disc lies there, i4, h × w.
    """
    height, width = depth.shape
    for i in range(len(points)):
        column, row, z = round(points[i, 0]), round(points[i, 1]), np.float32(points[i, 2])
        for v in range(max(row - radius, 0), min(row + radius, height - 1) + 1):
            reach = math.floor(math.sqrt(radius * radius - (v - row) ** 2))
            for u in range(max(column - reach, 0), min(column + reach, width - 1) + 1):
                if z < depth[v, u]:
                    depth[v, u] = z
                    owner[v, u] = i


@loop(error_model="numpy")
def turn_to_viewer(
    points: np.ndarray,
    faces: np.ndarray,
    normals: np.ndarray,
    seen: np.ndarray,
    owner: np.ndarray,
    shown: np.ndarray,
    outside: np.ndarray,
) -> None:
    """Interpolate the corners' normals at the samples that show a triangle.

    Args:
        points: Corners in samples, u v and depth, f8, n × 3.
        faces: Their numbers, m × 3.
        normals: Unit normal of each corner in the view frame, n × 3.
        seen: Row and column of each sample, k × 2.
        owner: The triangle that each shows, k.
        shown: Filled with unit normals, turned to the viewer, f4, k × 3.
        outside: Filled with whether the viewer looks at the triangle's front, k.
    """
    for i in range(len(seen)):
        a, b, c = faces[owner[i]]
        au, av = points[a, 0], points[a, 1]
        bu, bv = points[b, 0] - au, points[b, 1] - av
        cu, cv = points[c, 0] - au, points[c, 1] - av
        area = bu * cv - bv * cu
        du, dv = seen[i, 1] - au, seen[i, 0] - av
        of_b = min(max((du * cv - dv * cu) / area, 0.0), 1.0)
        of_c = min(max((bu * dv - bv * du) / area, 0.0), 1.0 - of_b)
        of_a = 1.0 - of_b - of_c
        x = of_a * normals[a, 0] + of_b * normals[b, 0] + of_c * normals[c, 0]
        y = of_a * normals[a, 1] + of_b * normals[b, 1] + of_c * normals[c, 1]
        z = of_a * normals[a, 2] + of_b * normals[b, 2] + of_c * normals[c, 2]
        # Outside is where the triangle itself, not the smoothed normal, faces the viewer.
        outside[i] = area < 0.0
        length = max(math.sqrt(x * x + y * y + z * z), 1e-12)
        turn = (1.0 if area < 0.0 else -1.0) / length
        shown[i, 0], shown[i, 1], shown[i, 2] = turn * x, turn * y, turn * z


@loop(error_model="numpy")
def sum_at_corners(faces: np.ndarray, values: np.ndarray, sums: np.ndarray) -> None:
    """Add each triangle's vector to its three corners.

    Args:
        faces: Numbers of the corners, m × 3.
        values: One vector a triangle, m × 3.
        sums: One vector a corner, n × 3; added to.
    """
    for f in range(len(faces)):
        for k in range(3):
            for axis in range(3):
                sums[faces[f, k], axis] += values[f, axis]


@loop(error_model="numpy")
def place_samples(
    seen: np.ndarray, depth: np.ndarray, world_from_samples: np.ndarray, points: np.ndarray
) -> None:
    """Place samples in the world.

    Args:
        seen: Row and column of each sample, k × 2.
        depth: Depth of every sample, f4, h × w.
        world_from_samples: An affine map of u, v and depth, 3 × 4.
        points: Filled with the places, f8, k × 3.
    """
    for i in range(len(seen)):
        v, u = seen[i]
        z = np.float64(depth[v, u])
        for axis in range(3):
            turn = world_from_samples[axis]
            points[i, axis] = turn[0] * u + turn[1] * v + turn[2] * z + turn[3]


@loop(error_model="numpy")
def average_samples(
    seen: np.ndarray,
    paint: np.ndarray,
    light: np.ndarray,
    background: float,
    side: int,
    picture: np.ndarray,
) -> None:
    """Make pixels of lit samples; those that show nothing have the background's grey.

    Args:
        seen: Row and column of each sample that shows something, k × 2.
        paint: Its colour from 0 to 1, f4, k × 3.
        light: How bright it is lit, k.
        background: Grey from 0 to 1.
        side: Samples along each side of a pixel.
        picture: Filled with red, green and blue, u1, h × w × 3.
    """
    sums = np.full(picture.shape, background * side * side, np.float32)
    for i in range(len(seen)):
        row, column = seen[i, 0] // side, seen[i, 1] // side
        for channel in range(3):
            lit = min(max(paint[i, channel] * light[i], 0.0), 1.0)
            sums[row, column, channel] += lit - background
    for row in range(picture.shape[0]):
        for column in range(picture.shape[1]):
            for channel in range(3):
                picture[row, column, channel] = round(
                    255.0 * sums[row, column, channel] / (side * side)
                )
