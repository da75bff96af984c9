"""Where rays meet surfaces."""

import numpy as np

from ..errors import Degenerate
from ..types.arrays import Points
from ..types.plane import Plane
from ..types.rays import Rays

_PARALLEL = 1e-9
"""Sine of the angle to the plane below which a ray counts as parallel to it."""


def intersect_rays_with_plane(rays: Rays, plane: Plane) -> Points:
    """Find where each ray meets a plane.

    Args:
        rays: The rays, in the plane's frame.
        plane: The plane to meet.

    Returns:
        The meeting points [m]; row i belongs to ray i, and is NaN where ray i is parallel to the
        plane or meets it behind its origin.

    Raises:
        Degenerate: There are rays, and every one is parallel to the plane.

    References:
        Hartley and Zisserman, Multiple View Geometry, 2nd edition, section 3.2.
    """
    along = rays.directions @ plane.normal
    parallel = np.abs(along) < _PARALLEL
    if parallel.size > 0 and parallel.all():
        raise Degenerate(
            f"All {len(along)} rays are parallel to the plane. Check that the plane and the rays "
            "are in one frame, and that the laser does not point along the optical axis."
        )
    with np.errstate(divide="ignore", invalid="ignore"):
        reach = -plane.distance_to(rays.origins) / along
    reach = np.where(~parallel & (reach >= 0), reach, np.nan)
    return rays.origins + reach[:, None] * rays.directions
