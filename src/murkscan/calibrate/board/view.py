"""A board as one photo shows it."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from ...types.arrays import Indices, Pixels, Points
from .chessboard import Chessboard


@dataclass(frozen=True, eq=False)
class BoardView:
    """The inner corners found in one photo."""

    name: str
    """Name of the photo, for messages and files."""
    corners: Pixels
    """Inner corners, row after row as the board has them [px]; of length 0 where none was found."""
    is_first_dark: bool = True
    """Whether the square before the first corner, up and left, is dark."""
    numbers: Indices | None = None
    """Which of the board's corners these are; None for all of them."""
    is_placed: bool = True
    """Whether it is sure which of the board's corners these are: not where the picture cuts it."""
    reason: str = "shows no board"
    """Why no board was found, where none was; continues the photo's name."""

    @property
    def is_found(self) -> bool:
        """Tell whether the photo shows the board."""
        return len(self.corners) > 0

    def grid(self, board: Chessboard) -> Float[np.ndarray, "rows columns 2"]:
        """Lay the corners out as the board has them [px]; NaN where one was not found."""
        grid = np.full((board.num_corners, 2), np.nan)
        grid[np.arange(len(self.corners)) if self.numbers is None else self.numbers] = self.corners
        return grid.reshape(board.rows, board.columns, 2)

    def places(self, flat: Points) -> Float[np.ndarray, "m 3"]:
        """Give those of the board's points that the corners show."""
        return flat if self.numbers is None else flat[self.numbers]


def as_opencv(
    views: Sequence[BoardView], flat: Points
) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Give board points and corners of each view as OpenCV's calibration takes them."""
    return [view.places(flat).astype(np.float32) for view in views], [
        np.ascontiguousarray(view.corners[:, None], dtype=np.float32) for view in views
    ]
