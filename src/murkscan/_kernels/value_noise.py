"""Smooth random fields: random values at the corners of grids, blended in between."""

import numpy as np

from .compiled import loop, part


@part(inline="always")
def _blend(t: float) -> float:
    """Go from 0 to 1 with two derivatives that vanish at both ends."""
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0)


@loop(error_model="numpy")
def value_noise(
    points: np.ndarray,
    axes: np.ndarray,
    shifts: np.ndarray,
    weights: np.ndarray,
    order: np.ndarray,
    values: np.ndarray,
) -> np.ndarray:
    """Sum the fields of several grids at points (n 3).

    Grid k has the coordinates axes[k] @ point + shifts[k], and a cell is 1 wide. The value of a
    corner is drawn from `values` by way of the permutation `order`; both have the same length, a
    power of two.

    References:
        Perlin, An image synthesizer, SIGGRAPH 1985 (the table of permutations); Perlin, Improving
        noise, SIGGRAPH 2002 (the blending).
    """
    last = len(order) - 1
    field = np.empty(len(points))
    for i in range(len(points)):
        px, py, pz = points[i, 0], points[i, 1], points[i, 2]
        total = 0.0
        for k in range(len(weights)):
            x = axes[k, 0, 0] * px + axes[k, 0, 1] * py + axes[k, 0, 2] * pz + shifts[k, 0]
            y = axes[k, 1, 0] * px + axes[k, 1, 1] * py + axes[k, 1, 2] * pz + shifts[k, 1]
            z = axes[k, 2, 0] * px + axes[k, 2, 1] * py + axes[k, 2, 2] * pz + shifts[k, 2]
            fx, fy, fz = np.floor(x), np.floor(y), np.floor(z)
            cx, cy, cz = int(fx), int(fy), int(fz)
            u, v, w = _blend(x - fx), _blend(y - fy), _blend(z - fz)
            z0, z1 = cz & last, (cz + 1) & last
            level = 0.0
            for p in range(2):
                row = order[(cx + p) & last]
                share = u if p == 1 else 1.0 - u
                near, far = order[(row + cy) & last], order[(row + cy + 1) & last]
                low = values[(near + z0) & last] * (1.0 - w) + values[(near + z1) & last] * w
                high = values[(far + z0) & last] * (1.0 - w) + values[(far + z1) & last] * w
                level += share * (low * (1.0 - v) + high * v)
            total += weights[k] * level
        field[i] = total
    return field
