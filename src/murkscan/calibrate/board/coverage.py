"""Which parts of the picture the corners were in."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool

from ...types.arrays import Pixels

_CELLS = 10
"""Cells of the grid along each side of the picture."""
_ROWS, _COLUMNS = ("top", "middle", "bottom"), ("left", "middle", "right")


@dataclass(frozen=True, eq=False)
class BoardCoverage:
    """How much of the picture was used."""

    share: float
    """Share of the cells of a 10 by 10 grid in which a corner was."""
    emptiest_place: str
    """Where most cells are empty, in words that follow "the board"."""
    cells: Bool[np.ndarray, "10 10"]
    """In which cells a corner was, the top row first."""


def cover(corners: Pixels, size: tuple[int, int]) -> BoardCoverage:
    """Tell how much of a picture of this width and height corners cover."""
    width, height = size
    column, row = (corners / [width, height] * _CELLS).astype(int).clip(0, _CELLS - 1).T
    seen = np.zeros((_CELLS, _CELLS))
    seen[row, column] = 1.0
    thirds = np.array([0, 3, 7])
    sizes = np.add.reduceat(np.add.reduceat(np.ones_like(seen), thirds, 0), thirds, 1)
    shares = np.add.reduceat(np.add.reduceat(seen, thirds, 0), thirds, 1) / sizes
    place = _ROWS[int(np.argmin(shares)) // 3], _COLUMNS[int(np.argmin(shares)) % 3]
    where = "in the middle" if place == ("middle", "middle") else f"at the {' '.join(place)}"
    return BoardCoverage(float(seen.mean()), where, seen > 0)
