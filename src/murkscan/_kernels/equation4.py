"""The paper's equation (4), from pixels to points in one pass over memory."""

import numpy as np

from .compiled import loop
from .distortion import straighten


@loop()
def locate_points(
    pixels: np.ndarray,
    focal: tuple[float, float],
    centre: tuple[float, float],
    distortion: np.ndarray,
    along: int,
    baseline: float,
    cot: float,
) -> np.ndarray:
    """Points (n 3) of pixels (n 2), the laser along image axis 0 or 1; NaN behind the camera."""
    points = np.empty((len(pixels), 3))
    bent = np.any(distortion != 0)
    scale_u, scale_v = 1.0 / focal[0], 1.0 / focal[1]
    for i in range(len(pixels)):
        x, y = (pixels[i, 0] - centre[0]) * scale_u, (pixels[i, 1] - centre[1]) * scale_v
        if bent:
            x, y = straighten(x, y, distortion)
        depth = baseline / (cot - (x if along == 0 else y))
        depth = depth if 0.0 < depth < np.inf else np.nan
        points[i, 0], points[i, 1], points[i, 2] = x * depth, y * depth, depth
    return points
