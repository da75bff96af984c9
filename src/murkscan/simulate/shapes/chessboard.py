"""The flat board of a chessboard; its squares are a texture, `Checkered`."""

from dataclasses import dataclass
from typing import final

import numpy as np

from ...errors import InputError
from ...types.mesh import Mesh
from .base import AbstractShape, check_sizes
from .plane import rectangle_mesh


@final
@dataclass(frozen=True)
class Chessboard(AbstractShape):
    """A flat board with a margin one square wide around its squares.

    The origin is the first inner corner, x along a row of corners, y along a column, as in
    calibration; the board lies in z = 0 and faces the camera::

        · · · · · ·
        · ■ □ ■ □ ·        3 columns and 2 rows of inner corners: the squares reach
        · □ ┼─┼─┼▶ x       from -1 to 3 squares in x and from -1 to 2 squares in y,
        · ■ ┼ ┼ ┼ ·        and the margin (·) one square farther
        · · ▼ · · ·
            y
    """

    columns: int = 9
    """Inner corners in a row."""
    rows: int = 6
    """Inner corners in a column."""
    square: float = 0.03
    """Side of a square [m]."""

    def __post_init__(self) -> None:
        """Refuse a board without corners or without size."""
        check_corners(self.columns, self.rows)
        check_sizes("A chessboard", square=self.square)

    def mesh(self) -> Mesh:
        """Make two triangles, without a back."""
        low, high = np.array([-2.0, -2.0]), np.array([self.columns + 1.0, self.rows + 1.0])
        return rectangle_mesh(low * self.square, high * self.square)


def check_corners(columns: int, rows: int) -> None:
    """Refuse a board with fewer than 2 x 2 inner corners.

    Raises:
        InputError: It has fewer.
    """
    if min(columns, rows) < 2:
        raise InputError(
            f"A chessboard needs at least 2 x 2 inner corners, got columns = {columns} and "
            f"rows = {rows}: count where two black squares touch."
        )
