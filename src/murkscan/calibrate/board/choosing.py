"""Which pictures of a board that is held before a live camera become photos of it."""

from typing import Literal

import numpy as np
from jaxtyping import Float
from scipy.ndimage import map_coordinates

from ...types.arrays import Image, Pixels
from .chessboard import Chessboard
from .view import BoardView

Judgement = Literal["take", "no board", "moves", "is not sharp", "is as before"]
"""Take it; else why not, in words that follow "the board"."""
_STILL = 8.0
"""Motion of the corners [px/s] up to which a board is still: in 40 ms, an exposure that is long, a
third of a pixel."""
_SHARP = 4.0
"""Width of an edge [px] from which it is not sharp: that of a blur of 1.6 px, σ √(2π)."""
_NEW = 0.08
"""Mean shift of the corners, over the picture's width, from which a view is another one: fifteen
such views, side by side, fill the picture."""
_REACH, _STEP = 6.0, 0.5
"""How far an edge is followed across itself, and in which steps [px]."""


class PhotoChooser:
    """Judges views as they come: the board shall be still, sharp, and otherwise than before."""

    def __init__(self, board: Chessboard) -> None:
        """Begin with no photo taken."""
        self._board = board
        self._taken: list[Pixels] = []
        self._last: tuple[Pixels, float] | None = None

    def judge(self, view: BoardView, image: Image, time: float) -> Judgement:
        """Judge a picture.

        Args:
            view: The board in it.
            image: The picture.
            time: When it came [s].
        """
        if not view.is_found:
            self._last = None
            return "no board"
        last, self._last = self._last, (view.corners, time)
        if last is None or not self._is_still(*last, view.corners, time):
            return "moves"
        if not edge_width(image, view, self._board) <= _SHARP:
            return "is not sharp"
        if any(_shift(taken, view.corners) < _NEW * image.shape[1] for taken in self._taken):
            return "is as before"
        return "take"

    def take(self, view: BoardView) -> None:
        """Remember a view of which a photo was taken."""
        if view.is_found:
            self._taken.append(view.corners)

    def _is_still(self, before: Pixels, since: float, now: Pixels, time: float) -> bool:
        return time > since and _shift(before, now) <= _STILL * (time - since)


def edge_width(image: Image, view: BoardView, board: Chessboard) -> float:
    """Measure how wide the edges between the board's squares are: contrast over steepest slope.

    Args:
        image: The picture.
        view: The board in it.
        board: The board.

    Returns:
        The median width [px]; infinite where there is no contrast.
    """
    grid = view.grid(board)
    first, second = grid[:, :-1].reshape(-1, 2), grid[:, 1:].reshape(-1, 2)
    along = second - first
    length = np.linalg.norm(along, axis=1, keepdims=True)
    across = np.stack([-along[:, 1], along[:, 0]], axis=1) / np.maximum(length, 1e-9)
    # Within the two squares that meet at the edge.
    reach = min(_REACH, 0.4 * float(np.nanmedian(length)))
    steps = np.arange(-reach, reach + _STEP / 2, _STEP)
    places = (first + second)[:, None] / 2 + steps[None, :, None] * across[:, None]
    profiles = map_coordinates(image.astype(np.float32), places[..., ::-1].T, order=1)
    return _median_width(profiles.T)


def _median_width(profiles: Float[np.ndarray, "edges steps"]) -> float:
    contrast = np.abs(profiles[:, -1] - profiles[:, 0])
    slope = np.abs(np.diff(profiles, axis=1)).max(axis=1) / _STEP
    lit = slope > 0
    return float(np.median(contrast[lit] / slope[lit])) if lit.any() else np.inf


def _shift(one: Pixels, other: Pixels) -> float:
    """Give how far the corners are moved, in the mean [px]; far where others were found."""
    if one.shape != other.shape:
        return np.inf
    return float(np.linalg.norm(one - other, axis=1).mean())
