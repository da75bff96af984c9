"""Second branches: a surface that goes on behind the edge of a nearer one."""

import numpy as np
from jaxtyping import Float

from ..types.arrays import Mask
from .ridges import Marks, Ridges

_STEP = 3.0
"""Pixels from one line to the next beyond which a branch is another one."""
_GAP = 3
"""Scan lines that may be missing where a surface passes behind an edge."""
_BEND = (1.5, 0.75)
"""Pixels by which it may be off there, and more for each line."""

Weights = Float[np.ndarray, "lines most"]
"""One number a ridge."""
Places = Float[np.ndarray, "_ 2"]
"""Scan line and position, one a row."""


def go_on_beside(ridges: Ridges, first: Weights, second: Weights) -> Marks:
    """Tell which ridges of a second chain are a surface that the first chain leaves at an edge.

    Every ray of the laser ends on one surface, so a scan line shows two only beside an edge, where
    camera and laser look past it by different ways: there the first chain jumps from one to the
    other, and either goes on for some lines. What runs beside the stripe without such a link is
    its reflection, or a mark on the surface.

    Args:
        ridges: Of one frame.
        first: Posterior of each ridge along the first chain.
        second: The same without the ridges that the first chain took, or that are near them.
    """
    marks = np.zeros(ridges.positions.shape, bool)
    line, which = np.nonzero(second > 0.5)
    if len(line) == 0:
        return marks
    taken = np.nonzero(first > 0.5)
    places = np.stack([taken[0], ridges.straight[taken]], axis=1)
    beside = np.stack([line, ridges.straight[line, which]], axis=1)
    off = np.abs(np.diff(beside, axis=0))
    cuts = np.flatnonzero((off[:, 0] > _GAP) | (off[:, 1] > _STEP)) + 1
    starts, ends = np.append(0, cuts), np.append(cuts, len(line))
    met = _meet(beside[starts], places) | _meet(beside[ends - 1], places)
    marks[line, which] = np.repeat(met, ends - starts)
    return marks


def _meet(ends: Places, others: Places) -> Mask:
    """Tell at which ends of branches the first chain has been, or will be."""
    gap, off = np.moveaxis(np.abs(ends[:, None] - others), 2, 0)
    return ((gap <= _GAP) & (off < _BEND[0] + _BEND[1] * gap)).any(axis=1)
