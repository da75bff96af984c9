"""The flat chessboard that is shown to the camera."""

from dataclasses import dataclass

import numpy as np

from ...errors import InputError
from ...types.arrays import Mask, Points, Scalars


@dataclass(frozen=True)
class Margin:
    """How far the flat sheet runs on beyond the printed squares, on each side [m]."""

    left: float
    right: float
    top: float
    bottom: float

    def __post_init__(self) -> None:
        """Refuse a negative margin."""
        if not min(self.left, self.right, self.top, self.bottom) >= 0:
            raise InputError(
                f"A margin must be 0 or more on each side, got {self.left * 1e3:g}, "
                f"{self.right * 1e3:g}, {self.top * 1e3:g}, {self.bottom * 1e3:g} mm."
            )


@dataclass(frozen=True)
class Chessboard:
    """A chessboard of which the inner corners count.

    Its frame has the first inner corner as origin, x along a row, y down the columns, z away from
    the camera::

        ■ □ ■ □        3 columns and 2 rows of inner corners:
        □ ┼─┼─┼▶ x     the squares reach from -1 to 3 squares in x
        ■ ┼ ┼ ┼        and from -1 to 2 squares in y
        □ ▼ y □
    """

    columns: int
    """Inner corners in a row."""
    rows: int
    """Inner corners in a column."""
    square: float
    """Side of a square [m]."""

    def __post_init__(self) -> None:
        """Refuse boards that cannot be."""
        if not (3 <= self.columns <= 100 and 3 <= self.rows <= 100):
            raise InputError(
                f"A board needs at least 3x3 inner corners, got {self}: count the corners where "
                "two black squares touch, not the squares."
            )
        if not (np.isfinite(self.square) and self.square > 0):
            raise InputError(
                f"The squares of a board must be larger than 0 mm, got {self.square * 1e3:g} mm."
            )

    def __str__(self) -> str:
        """Name the board as users do: 9x6."""
        return f"{self.columns}x{self.rows}"

    @property
    def num_corners(self) -> int:
        """Count the inner corners."""
        return self.columns * self.rows

    def points(self) -> Points:
        """Give the inner corners in the board's frame [m], row after row."""
        y, x = np.mgrid[: self.rows, : self.columns]
        return np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1) * self.square

    def is_on_paper(
        self, points: Points, margin: Margin, *, rim: float, is_first_dark: bool
    ) -> Mask:
        """Tell which points of the board's plane lie on its blank, flat parts.

        Args:
            points: Points in the board's frame [m]; z is not looked at, NaN is never on paper.
            margin: How far the sheet runs on beyond the squares.
            rim: How far points keep away from every edge [m].
            is_first_dark: Whether the square before the first corner, up and left, is dark.

        Returns:
            True on light squares and on the margin, at least `rim` from any dark square and from
            the edge of the sheet.
        """
        x, y = points[:, 0] / self.square, points[:, 1] / self.square
        near, far = -1 - rim / self.square, rim / self.square
        outside = (x < near) | (x > self.columns + far) | (y < near) | (y > self.rows + far)
        is_inside_squares = (x > -1) & (x < self.columns) & (y > -1) & (y < self.rows)
        is_light = ((np.floor(x) + np.floor(y)) % 2 != 0) == is_first_dark
        to_edge = np.minimum(_to_whole_number(x), _to_whole_number(y)) * self.square
        (left, top, _), _, (right, bottom, _), _ = self.outline(margin)
        u, v = points[:, 0], points[:, 1]
        on_sheet = (u >= left + rim) & (u <= right - rim) & (v >= top + rim) & (v <= bottom - rim)
        return on_sheet & (outside | (is_inside_squares & is_light & (to_edge >= rim)))

    def outline(self, margin: Margin) -> Points:
        """Give the four corners of the sheet in the board's frame [m], clockwise."""
        left, right = -self.square - margin.left, self.columns * self.square + margin.right
        top, bottom = -self.square - margin.top, self.rows * self.square + margin.bottom
        return np.array(
            [[left, top, 0.0], [right, top, 0.0], [right, bottom, 0.0], [left, bottom, 0.0]]
        )


def _to_whole_number(values: Scalars) -> Scalars:
    return np.abs(values - np.round(values))
