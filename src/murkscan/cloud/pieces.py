"""Which points of a scan hang together."""

import numpy as np
import scipy

from ..geometry.grid import ScanGrid
from ..types.arrays import Indices

_SUPPORTS = ((0, 1), (0, 2), (1, 0), (1, 1), (1, -1), (2, 0))
"""Cells, in profiles and scan lines, where a point of the same surface may lie; and opposite."""


def number_pieces(grid: ScanGrid) -> Indices:
    """Number the piece of each point: points that touch, over gaps of one cell, are of one piece.

    Args:
        grid: The points in their grid; at least one.
    """
    here = np.arange(len(grid.cloud))
    ours, theirs = [], []
    for profiles, lines in _SUPPORTS:
        there = grid.nearest(profiles, lines)
        touching = np.flatnonzero(grid.touches(here, there, profiles, lines))
        ours.append(touching.astype(np.int32))
        theirs.append(there[touching].astype(np.int32))
    pairs = (np.concatenate(ours), np.concatenate(theirs))
    shape = (len(here), len(here))
    touches = scipy.sparse.coo_array((np.ones(len(pairs[0]), bool), pairs), shape=shape)
    return scipy.sparse.csgraph.connected_components(touches, directed=False)[1].astype(np.int64)
