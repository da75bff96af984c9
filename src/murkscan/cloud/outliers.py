"""Points that are no surface: snow, glints, slips of the finder."""

import numpy as np

from ..geometry.grid import NONE, ScanGrid
from ..types.arrays import Indices, Mask
from ..types.cloud import PointCloud

_SUPPORTS = ((0, 1), (0, 2), (1, 0), (1, 1), (1, -1), (2, 0))
"""Cells, in profiles and scan lines, where a point of the same surface may lie; and opposite."""


def remove_outliers(cloud: PointCloud, *, max_jump: float | None = None) -> PointCloud:
    """Take out points that stand alone, and those in front of or behind both their neighbours.

    The neighbours are those of the scan's grid, so it does not matter that points lie closer along
    the stripe than from profile to profile. A point at a depth jump, or at the rim of the surface,
    has neighbours on one side and stays.

    Args:
        cloud: The points of a scan.
        max_jump: Largest distance between neighbours on one surface [m]. None: told from the
            points, generously: five times the usual distance, and four standard deviations.

    Returns:
        The points that stay, in their order.

    Raises:
        InputError: A point is not finite, or max_jump is not positive.
    """
    if len(cloud) == 0:
        return cloud
    grid = ScanGrid.from_cloud(cloud, max_jump=max_jump)
    return cloud[~(_stand_alone(grid) | _stand_out(grid))]


def _stand_alone(grid: ScanGrid) -> Mask:
    """Find the points that touch no other."""
    alone = np.ones(len(grid.cloud), bool)
    here = np.arange(len(alone))
    for profiles, lines in _SUPPORTS:
        there = grid.nearest(profiles, lines)
        touching = grid.touches(here, there, profiles, lines)
        alone[touching] = False
        alone[there[touching]] = False
    return alone


def _stand_out(grid: ScanGrid) -> Mask:
    """Find the points that leave their profile and come back: a spike, not a slope.

    On a slope, however steep, the neighbours on the two sides lie in opposite directions.
    """
    here = np.arange(len(grid.cloud))
    sides: dict[int, list[Indices]] = {-1: [], 1: []}
    holds = np.zeros(len(here), bool)
    for side, distance in ((-1, 1), (-1, 2), (1, 1), (1, 2)):
        there = grid.nearest(0, side * distance)
        # A spike's neighbours deserve no double allowance for being two scan lines away.
        holds |= grid.touches(here, there, 0, side)
        sides[side].append(there)
    returns = np.zeros(len(here), bool)
    for left in sides[-1]:
        for right in sides[1]:
            returns |= (left != NONE) & (right != NONE) & _same_way(grid, left, right)
    return returns & ~holds


def _same_way(grid: ScanGrid, left: Indices, right: Indices) -> Mask:
    points = grid.cloud.points
    return np.einsum("ij,ij->i", points[left] - points, points[right] - points) > 0
