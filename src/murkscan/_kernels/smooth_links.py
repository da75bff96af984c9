"""Local quadratic fits along chains of points, each as long as its own noise lets it be."""

import numpy as np

from .compiled import loop, part

_NONE = -1
_FEWEST = 5
"""Points below which a parabola says nothing that the point itself does not."""


@loop(error_model="numpy")
def fit_heights(
    points: np.ndarray,
    normals: np.ndarray,
    sigma: np.ndarray,
    forwards: np.ndarray,
    backwards: np.ndarray,
    reach: int,
    tolerance: float,
) -> np.ndarray:
    """Fit a parabola to the neighbours' heights over each point's tangent plane.

    The chain grows by one neighbour to each side; the longest counts whose heights still leave the
    parabola by no more than `tolerance` standard deviations (RMS), with all shorter ones.

    Args:
        points: Positions [m], n × 3.
        normals: Unit normals, n × 3; zero where there is none: the height is 0.
        sigma: Standard deviation of each point [m], n, above 0.
        forwards: Number of the next point of each point's chain; -1 at its end.
        backwards: Number of the one before.
        reach: Neighbours to each side, at most.
        tolerance: RMS of the heights' distance from the parabola, in their own deviations.

    Returns:
        Height of the parabola at each point [m], n.
    """
    heights = np.zeros(len(points))
    for i in range(len(points)):
        nx, ny, nz = normals[i, 0], normals[i, 1], normals[i, 2]
        if nx == 0 and ny == 0 and nz == 0:
            continue
        heights[i] = _fit_one(i, points, nx, ny, nz, sigma, forwards, backwards, reach, tolerance)
    return heights


@part(error_model="numpy")
def _fit_one(
    i: int,
    points: np.ndarray,
    nx: float,
    ny: float,
    nz: float,
    sigma: np.ndarray,
    forwards: np.ndarray,
    backwards: np.ndarray,
    reach: int,
    tolerance: float,
) -> float:
    """Give the height of the longest parabola that describes one point's chain."""
    px, py, pz = points[i, 0], points[i, 1], points[i, 2]
    weight = 1.0 / (sigma[i] * sigma[i])
    s0, s1, s2, s3, s4 = weight, 0.0, 0.0, 0.0, 0.0
    t0, t1, t2, hh = 0.0, 0.0, 0.0, 0.0
    scale, height, count = 0.0, 0.0, 1
    ahead, behind = i, i
    for _ in range(reach):
        ahead = forwards[ahead]
        behind = backwards[behind]
        # Both sides or none: a fit to one side would carry the rim on a lever.
        if ahead == _NONE or behind == _NONE:
            break
        for side in range(2):
            j = ahead if side == 0 else behind
            dx, dy, dz = points[j, 0] - px, points[j, 1] - py, points[j, 2] - pz
            h = dx * nx + dy * ny + dz * nz
            s = np.sqrt(max(dx * dx + dy * dy + dz * dz - h * h, 0.0))
            if scale == 0.0:
                scale = s if s > 0.0 else 1.0
            s = s / scale if side == 0 else -s / scale
            w = 1.0 / (sigma[j] * sigma[j])
            s0 += w
            s1 += w * s
            s2 += w * s * s
            s3 += w * s * s * s
            s4 += w * s * s * s * s
            t0 += w * h
            t1 += w * h * s
            t2 += w * h * s * s
            hh += w * h * h
            count += 1
        if count < _FEWEST:
            continue
        at0, left = _solve(s0, s1, s2, s3, s4, t0, t1, t2, hh)
        # Points in one place, or without weight, have no parabola: that is NaN, which fits nothing.
        if not left <= tolerance * tolerance * count:
            break
        height = at0
    return height


@part(error_model="numpy")
def _solve(
    s0: float, s1: float, s2: float, s3: float, s4: float,
    t0: float, t1: float, t2: float, hh: float,
) -> tuple[float, float]:  # fmt: skip
    """Give the parabola's height in the middle, and the weighted squares that it leaves.

    The normal equations have the moments s of the places and t of the heights; hh is the sum of the
    squared heights.
    """
    a, b, c = s2 * s4 - s3 * s3, s2 * s3 - s1 * s4, s1 * s3 - s2 * s2
    det = s0 * a + s1 * b + s2 * c
    if not det > 1e-12 * s0 * s2 * s4:
        return np.nan, np.nan
    d, e, f = s0 * s4 - s2 * s2, s1 * s2 - s0 * s3, s0 * s2 - s1 * s1
    at0 = (a * t0 + b * t1 + c * t2) / det
    at1 = (b * t0 + d * t1 + e * t2) / det
    at2 = (c * t0 + e * t1 + f * t2) / det
    return at0, hh - at0 * t0 - at1 * t1 - at2 * t2
