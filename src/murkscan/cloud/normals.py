"""Normals from tangents along and across the scan's grid."""

import math

import numpy as np

from ..geometry.grid import NONE, ScanGrid, reverse_links
from ..types.arrays import Indices, Normals, Points

_TILT = 0.05
"""Standard deviation of a tangent's direction that is small enough [rad]."""
_MAX_ALONG = 16
"""Scan lines to each side, at most, that a tangent is fitted to."""
_MAX_ACROSS = 3
"""Profiles to each side, at most, that a tangent is fitted to."""
_PARALLEL = 0.05
"""Sine of the angle between the two tangents below which they do not make a normal."""


def estimate_normals(grid: ScanGrid, cameras: Points) -> Normals:
    """Find the surface's normal at every point, turned to the camera that saw it.

    The two tangents are slopes of straight lines fitted to the neighbours along and across, over
    no more of them than sigma asks for. Nothing reaches over a depth jump.

    Args:
        grid: The points in their grid.
        cameras: Optical centre of the camera when it saw each point, in the points' frame [m].

    Returns:
        Unit normals; zero where a point lacks neighbours in either direction.
    """
    if len(grid.cloud) == 0:
        return np.zeros((0, 3), np.float32)
    points = grid.cloud.points
    sigma = float(np.nan_to_num(np.median(grid.cloud.sigma)))
    # A tangent need not be shorter along the stripe than half the way to the next profile.
    by_spacing = round(0.5 * grid.usual_across / grid.usual_along) if grid.usual_along else 1
    reach = max(_enough(sigma, grid.usual_along, _MAX_ALONG), min(by_spacing, _MAX_ALONG // 2))
    along = _fit_tangents(points, _link_over_dropouts(grid, along=True), reach)
    reach = _enough(sigma, grid.usual_across, _MAX_ACROSS)
    across = _fit_tangents(points, _link_over_dropouts(grid, along=False), reach)
    normals = np.cross(along, across)
    length = np.linalg.norm(normals, axis=1)
    sound = length > _PARALLEL
    towards = np.einsum("ij,ij->i", normals, cameras - points)
    scale = np.where(sound, np.copysign(1.0, towards), 0.0) / np.where(sound, length, 1.0)
    return (normals * scale[:, None]).astype(np.float32)


def _enough(sigma: float, spacing: float, most: int) -> int:
    """Count the neighbours a side whose line fit has a direction good to `_TILT`."""
    for reach in range(1, most):
        squares = sum(step * step for step in range(1, reach + 1))
        if sigma <= _TILT * spacing * math.sqrt(2 * squares):
            return reach
    return most


def _link_over_dropouts(grid: ScanGrid, *, along: bool) -> Indices:
    """Link each point forwards, where the next cell is empty to the one after it."""
    steps = ((0, 1), (0, 2)) if along else ((1, 0), (1, 1), (1, -1), (2, 0))
    links = np.full(len(grid.cloud), NONE)
    for profiles, lines in steps:
        back = reverse_links(links)
        asking = np.flatnonzero(links == NONE)
        there = grid.nearest(profiles, lines, of=asking)
        # A point that another one is linked to already keeps its neighbour.
        free = grid.touches(asking, there, profiles, lines) & (back[there] == NONE)
        asking, there = asking[free], there[free]
        lengths = grid.distance(asking, there)
        shortest_first = np.argsort(lengths, kind="stable")
        _, first = np.unique(there[shortest_first], return_index=True)
        chosen = shortest_first[first]
        links[asking[chosen]] = there[chosen]
    return links


def _fit_tangents(points: Points, forwards: Indices, reach: int) -> Points:
    """Fit a line to the neighbours of each point: unit directions, zero without a neighbour."""
    slope = np.zeros_like(points)
    for links, sign in ((forwards, 1.0), (reverse_links(forwards), -1.0)):
        there = np.arange(len(points))
        for step in range(1, reach + 1):
            there = np.where(there == NONE, NONE, links[there])
            reached = np.flatnonzero(there != NONE)
            slope[reached] += sign * step * (points[there[reached]] - points[reached])
    length = np.linalg.norm(slope, axis=1)
    return slope / np.where(length > 0, length, 1.0)[:, None]
