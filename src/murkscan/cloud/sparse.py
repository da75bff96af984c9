"""Points without neighbours: snow, glints, slips of the finder."""

from dataclasses import dataclass
from typing import final

import numpy as np

from ..errors import InputError
from ..geometry.grid import NONE, ScanGrid
from ..types.arrays import Indices, Mask
from .base import AbstractOutlierRule, SeenCloud
from .pieces import number_pieces


@final
@dataclass(frozen=True)
class Sparse(AbstractOutlierRule):
    """Points of small pieces, and those in front of or behind both their neighbours.

    The neighbours are those of the scan's grid, so it does not matter that points lie closer along
    the stripe than from profile to profile. A point at a depth jump, or at the rim of the surface,
    has neighbours on one side and stays.
    """

    max_jump: float | None = None
    """Largest distance between neighbours on one surface [m]. None: told from the points,
    generously: five times the usual distance, and four standard deviations."""
    min_piece: int = 8
    """Points that must hang together, over gaps of one profile or scan line: of the specks of glow
    that a plain threshold finds in murk, 99 in 100 are smaller and false."""

    def __post_init__(self) -> None:
        """Refuse pieces of no points."""
        if self.min_piece < 1:
            raise InputError(f"min_piece must be 1 or more, got {self.min_piece}.")

    @property
    def cause(self) -> str:
        """See `AbstractOutlierRule.cause`."""
        return "density"

    def find(self, seen: SeenCloud) -> Mask:
        """See `AbstractOutlierRule.find`."""
        if len(seen.cloud) == 0:
            return np.zeros(0, bool)
        grid = seen.lay_grid(max_jump=self.max_jump)
        return _in_specks(grid, self.min_piece) | _stand_out(grid)


def _in_specks(grid: ScanGrid, min_piece: int) -> Mask:
    """Find the points of pieces that are too small."""
    piece = number_pieces(grid)
    return np.bincount(piece)[piece] < min_piece


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
