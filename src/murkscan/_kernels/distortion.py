"""Lens distortion of normalised image points, and its inverse."""

import numpy as np

from .compiled import loop, part


@part(inline="always")
def _bend(x: float, y: float, d: np.ndarray) -> tuple[float, float, float, float, float]:
    """Distorted x and y, and the distortion's derivatives dx/dx, dx/dy = dy/dx, dy/dy."""
    k1, k2, p1, p2, k3 = d[0], d[1], d[2], d[3], d[4]
    r2 = x * x + y * y
    radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))
    slope = 2.0 * (k1 + r2 * (2.0 * k2 + r2 * 3.0 * k3))
    bent_x = x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x)
    bent_y = y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y
    xx = radial + x * x * slope + 2.0 * p1 * y + 6.0 * p2 * x
    xy = x * y * slope + 2.0 * p1 * x + 2.0 * p2 * y
    yy = radial + y * y * slope + 6.0 * p1 * y + 2.0 * p2 * x
    return bent_x, bent_y, xx, xy, yy


@loop()
def distort_points(flat: np.ndarray, distortion: np.ndarray) -> np.ndarray:
    """Bend normalised points (n 2) by k1 k2 p1 p2 k3."""
    bent = np.empty_like(flat)
    for i in range(len(flat)):
        x, y, _, _, _ = _bend(flat[i, 0], flat[i, 1], distortion)
        bent[i, 0], bent[i, 1] = x, y
    return bent


@part()
def straighten(bent_x: float, bent_y: float, distortion: np.ndarray) -> tuple[float, float]:
    """Undo `distort_points` for one point; NaN where Newton's method finds no answer."""
    x, y, step = bent_x, bent_y, np.inf
    for _ in range(20):
        now_x, now_y, xx, xy, yy = _bend(x, y, distortion)
        off_x, off_y = bent_x - now_x, bent_y - now_y
        scale = 1.0 / (xx * yy - xy * xy)
        dx, dy = scale * (yy * off_x - xy * off_y), scale * (xx * off_y - xy * off_x)
        x, y = x + dx, y + dy
        step = abs(dx) + abs(dy)
        if step < 1e-13:
            break
    return (x, y) if step < 1e-9 else (np.nan, np.nan)


@loop()
def undistort_points(bent: np.ndarray, distortion: np.ndarray) -> np.ndarray:
    """Straighten normalised points (n 2); NaN where there is no answer."""
    flat = np.empty_like(bent)
    for i in range(len(bent)):
        flat[i, 0], flat[i, 1] = straighten(bent[i, 0], bent[i, 1], distortion)
    return flat
