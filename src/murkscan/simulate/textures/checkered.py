"""The squares of a chessboard."""

from dataclasses import dataclass
from typing import final

import numpy as np

from ...types.arrays import Points, Scalars
from ..shapes.base import check_sizes
from ..shapes.chessboard import check_corners
from .base import AbstractTexture, check_albedos


@final
@dataclass(frozen=True)
class Checkered(AbstractTexture):
    """The print of a `Chessboard` of the same fields: black and white squares, white around them.

    The origin is the first inner corner; the square before it, left and up, is black. z is not
    looked at.
    """

    columns: int = 9
    """Inner corners in a row."""
    rows: int = 6
    """Inner corners in a column."""
    square: float = 0.03
    """Side of a square [m]."""
    black: float = 0.04
    """Albedo of the black squares."""
    white: float = 0.85
    """Albedo of the white squares and of the margin."""

    def __post_init__(self) -> None:
        """Refuse a board without corners or without size, and albedos that are no shares."""
        check_corners(self.columns, self.rows)
        check_sizes("A chessboard", square=self.square)
        check_albedos("A chessboard", black=self.black, white=self.white)

    def albedo(self, points: Points) -> Scalars:
        """Give each point the albedo of its square, or that of the margin."""
        column, row = np.floor(points[:, :2] / self.square).T
        printed = (column >= -1) & (column < self.columns) & (row >= -1) & (row < self.rows)
        return np.where(printed & ((column + row) % 2 == 0), self.black, self.white)
