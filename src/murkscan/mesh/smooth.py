"""Even out a scan's noise along its own grid, by no more than the noise itself."""

import numpy as np

from .._kernels.smooth_links import fit_heights
from ..geometry.grid import ScanGrid, reverse_links
from ..types.arrays import Indices, Points, Scalars

_ALONG = 24
"""Scan lines to each side, at most. A finder that joins the centres of eight lines to each side
leaves errors alike over as many: a mean gains only over several times that."""
_ACROSS = 8
"""Profiles to each side, at most, for the same reason: such a finder joins two to each side."""
_TOLERANCE = 1.0
"""Distance of the points from a parabola (RMS), in their standard deviations, up to which it
describes them."""
_LEAST = 1e-9
"""Standard deviation that a point without one counts with [m]: the parabola goes through it."""


def smooth_points(grid: ScanGrid, along: Indices, across: Indices, *, most: float) -> Points:
    """Move each point along its normal to a parabola through its neighbours.

    First along the profile, then across the profiles. A parabola follows the curve of a hull, which
    a mean would flatten; it is made as long as the neighbours agree with it within their standard
    deviations, so that at an edge, a weld or a barnacle it is short, or there is none. Nothing
    reaches over a depth jump, and no point moves farther than its standard deviation allows.

    Args:
        grid: The points in their grid.
        along: Each point's next neighbour on the same surface along the profile.
        across: The same across the profiles.
        most: How far a point may move, in its own standard deviations.

    Returns:
        The points [m]; those without a normal, or whose sigma is 0, stay.
    """
    cloud = grid.cloud
    # Clouds of other programs may hold anything where they know nothing.
    normals = np.nan_to_num(cloud.normals.astype(np.float64), posinf=0.0, neginf=0.0)
    known = np.isfinite(cloud.sigma) & (cloud.sigma > 0)
    sigma = np.where(known, cloud.sigma, 0.0).astype(np.float64)
    limit = most * sigma
    moved = np.zeros(len(cloud))
    for links, reach in ((along, _ALONG), (across, _ACROSS)):
        points = cloud.points + moved[:, None] * normals
        moved += _heights(points, normals, sigma, links, reach)
        moved = np.clip(moved, -limit, limit)
    return cloud.points + moved[:, None] * normals


def _heights(
    points: Points, normals: Points, sigma: Scalars, links: Indices, reach: int
) -> Scalars:
    back = reverse_links(links)
    weighed = np.maximum(sigma, _LEAST)
    return fit_heights(points, normals, weighed, links, back, reach, _TOLERANCE)
