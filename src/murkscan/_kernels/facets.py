"""Small plane pieces of a surface, from the cells of a scan's own grid."""

import numpy as np

from .compiled import loop, part

MOMENTS = 11
"""What a cell sums: count, x, y, z, xx, xy, xz, yy, yz, zz, brightness."""
_SUMS = 14
"""What a plane's fit sums: count, u, v, h, uu, uv, vv, uh, vh, hh, brightness, it times u, v, h."""
_FEWEST = 6
"""Points of a plane."""
_ALL_SIDES = 1 << 1 | 1 << 7 | 1 << 3 | 1 << 5
"""Cells beside the middle one at (−1, 0), (1, 0), (0, −1) and (0, 1)."""


@loop(error_model="numpy")
def sum_cells(
    points: np.ndarray,
    profile: np.ndarray,
    cell: np.ndarray,
    bright: np.ndarray,
    rotations: np.ndarray,
    positions: np.ndarray,
    num_cells: int,
) -> np.ndarray:
    """Sum the points of each cell in the world, with their products.

    Args:
        points: In the vehicle's frame [m], n × 3.
        profile: Number of each point's pose, n.
        cell: Number of each point's cell, n.
        bright: Brightness of each point, n.
        rotations: world_from_vehicle, p × 3 × 3.
        positions: Of the vehicle, from an origin nearby lest products lose digits [m], p × 3.
        num_cells: Count of cells.

    Returns:
        c × 11; see `MOMENTS`.
    """
    sums = np.zeros((num_cells, 11))
    for i in range(len(points)):
        r, t, p = rotations[profile[i]], positions[profile[i]], points[i]
        x = r[0, 0] * p[0] + r[0, 1] * p[1] + r[0, 2] * p[2] + t[0]
        y = r[1, 0] * p[0] + r[1, 1] * p[1] + r[1, 2] * p[2] + t[1]
        z = r[2, 0] * p[0] + r[2, 1] * p[1] + r[2, 2] * p[2] + t[2]
        s = sums[cell[i]]
        s[0] += 1.0
        s[1] += x
        s[2] += y
        s[3] += z
        s[4] += x * x
        s[5] += x * y
        s[6] += x * z
        s[7] += y * y
        s[8] += y * z
        s[9] += z * z
        s[10] += bright[i]
    return sums


@loop(error_model="numpy")
def fit_facets(
    sums: np.ndarray, num_rows: int, num_columns: int, axes: np.ndarray, reach: int, jump: float
) -> tuple[np.ndarray, np.ndarray]:
    """Fit a plane, and the slope of the brightness, to each cell and those around it.

    The plane is a height along the row's line of sight over two axes across it; least squares of
    the heights of all points of (2·reach + 1)² cells.

    Args:
        sums: Of `sum_cells`, (rows · columns) × 11.
        num_rows: Rows of cells: groups of profiles.
        num_columns: Columns of cells: groups of scan lines.
        axes: Two axes across the line of sight and the one towards the sensor, of each row, as
            rows of a matrix, rows × 3 × 3.
        reach: Cells to each side.
        jump: Distance between the middles of two cells, for each cell between them, above which
            they are two surfaces [m].

    Returns:
        Of each cell 9 numbers: the unit normal (towards the sensor), the variance of the plane's
        slope for points of variance 1 along its two axes (u, v), mean square distance from the
        plane [m²], the points that made it, the slope of the brightness over u and over v. And the
        points' own mean, with the mean brightness, c × 4. NaN where there is no plane.
    """
    found = np.full((num_rows * num_columns, 9), np.nan)
    middle = np.full((num_rows * num_columns, 4), np.nan)
    for c in range(num_rows * num_columns):
        if sums[c, 0] > 0:
            for k in range(3):
                middle[c, k] = sums[c, 1 + k] / sums[c, 0]
            middle[c, 3] = sums[c, 10] / sums[c, 0]
    shape, total = (num_rows, num_columns), np.empty(_SUMS)
    for i in range(num_rows):
        for j in range(num_columns):
            c, a = i * num_columns + j, axes[i]
            if sums[c, 0] > 0 and _add_around(sums, middle, i, j, shape, a, reach, jump, total):
                _solve(total, a, found[c])
    return found, middle


@part(error_model="numpy")
def _add_around(
    sums: np.ndarray,
    middle: np.ndarray,
    i: int,
    j: int,
    shape: tuple[int, int],
    axes: np.ndarray,
    reach: int,
    jump: float,
    total: np.ndarray,
) -> bool:
    """Add up the cells around one that belong to its surface; tell whether they hold a plane.

    They do where some lie beside it on both sides, along both directions.
    """
    total[:] = 0.0
    num_rows, num_columns = shape
    m, sides = middle[i * num_columns + j], 0
    for di in range(max(-reach, -i), min(reach, num_rows - 1 - i) + 1):
        for dj in range(max(-reach, -j), min(reach, num_columns - 1 - j) + 1):
            d = (i + di) * num_columns + j + dj
            if sums[d, 0] == 0:
                continue
            ex, ey, ez = middle[d, 0] - m[0], middle[d, 1] - m[1], middle[d, 2] - m[2]
            far = jump * max(abs(di), abs(dj))
            if ex * ex + ey * ey + ez * ez <= far * far:
                sides |= 1 << (3 * (np.sign(di) + 1) + np.sign(dj) + 1)
                _add_cell(sums[d], m, middle[d, 3] - m[3], axes, total)
    return total[0] >= _FEWEST and (sides & _ALL_SIDES) == _ALL_SIDES


@part(error_model="numpy")
def _add_cell(
    s: np.ndarray, m: np.ndarray, bright: float, axes: np.ndarray, total: np.ndarray
) -> None:
    """Add a cell's moments about a place, along the axes u, v and h, and its brightness."""
    k = s[0]
    qx, qy, qz = s[1] / k - m[0], s[2] / k - m[1], s[3] / k - m[2]
    xx = s[4] - s[1] * s[1] / k + k * qx * qx
    xy = s[5] - s[1] * s[2] / k + k * qx * qy
    xz = s[6] - s[1] * s[3] / k + k * qx * qz
    yy = s[7] - s[2] * s[2] / k + k * qy * qy
    yz = s[8] - s[2] * s[3] / k + k * qy * qz
    zz = s[9] - s[3] * s[3] / k + k * qz * qz
    total[0] += k
    for one in range(3):
        at = axes[one, 0] * qx + axes[one, 1] * qy + axes[one, 2] * qz
        total[1 + one] += k * at
        total[11 + one] += k * bright * at
    total[4] += _form(axes[0], axes[0], xx, xy, xz, yy, yz, zz)
    total[5] += _form(axes[0], axes[1], xx, xy, xz, yy, yz, zz)
    total[6] += _form(axes[1], axes[1], xx, xy, xz, yy, yz, zz)
    total[7] += _form(axes[0], axes[2], xx, xy, xz, yy, yz, zz)
    total[8] += _form(axes[1], axes[2], xx, xy, xz, yy, yz, zz)
    total[9] += _form(axes[2], axes[2], xx, xy, xz, yy, yz, zz)
    total[10] += k * bright


@part(error_model="numpy")
def _solve(total: np.ndarray, axes: np.ndarray, found: np.ndarray) -> None:
    """Fit height and brightness over u and v; leave NaN where the points lie on one line."""
    n, su, sv, sh, b = total[0], total[1], total[2], total[3], total[10]
    suu, suv, svv = total[4] - su * su / n, total[5] - su * sv / n, total[6] - sv * sv / n
    suh, svh, shh = total[7] - su * sh / n, total[8] - sv * sh / n, total[9] - sh * sh / n
    bu, bv = total[11] - b * su / n, total[12] - b * sv / n
    det = suu * svv - suv * suv
    if not det > 1e-6 * (suu + svv) ** 2:
        return
    gu = (svv * suh - suv * svh) / det
    gv = (suu * svh - suv * suh) / det
    size = np.sqrt(1.0 + gu * gu + gv * gv)
    for k in range(3):
        found[k] = (axes[2, k] - gu * axes[0, k] - gv * axes[1, k]) / size
    found[3] = svv / det
    found[4] = suu / det
    found[5] = max(shh - gu * suh - gv * svh, 0.0) / max(n - 3.0, 1.0) / (size * size)
    found[6] = n
    found[7] = (svv * bu - suv * bv) / det
    found[8] = (suu * bv - suv * bu) / det


@part(inline="always")
def _form(
    p: np.ndarray, q: np.ndarray, xx: float, xy: float, xz: float, yy: float, yz: float, zz: float
) -> float:
    """Give pᵀ M q of a symmetric matrix M."""
    return (
        p[0] * (xx * q[0] + xy * q[1] + xz * q[2])
        + p[1] * (xy * q[0] + yy * q[1] + yz * q[2])
        + p[2] * (xz * q[0] + yz * q[1] + zz * q[2])
    )
