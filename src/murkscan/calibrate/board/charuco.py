"""A chessboard with markers in its light squares, of which a part is enough."""

from dataclasses import dataclass

import cv2
import numpy as np

from ...errors import InputError
from ...types.arrays import Image, Indices, Pixels
from .chessboard import Chessboard
from .marker import load_dictionary, require_dictionary
from .view import BoardView

_MIN_CORNERS = 8
"""Corners below which a view is not used: two rows of four."""
_WINDOW = 5
"""Half width of the refinement window at most [px]."""
_SHARE = 0.6
"""The same over the gap between a square's corner and its marker: no marker may be in it."""


@dataclass(frozen=True)
class Markers:
    """The markers of a ChArUco board."""

    size: float
    """Side of a marker [m]."""
    dictionary: str = "4X4_50"
    """Which markers, as OpenCV calls them without DICT_."""

    def __post_init__(self) -> None:
        """Refuse a dictionary that OpenCV has not."""
        require_dictionary(self.dictionary)


def find_charuco(photo: Image, board: Chessboard, markers: Markers, *, name: str = "") -> BoardView:
    """Find those corners of a ChArUco board that a photo shows, and refine them.

    Args:
        photo: The photo, grey, 8 bit.
        board: The chessboard that the markers stand in.
        markers: The markers.
        name: Name of the photo.

    Returns:
        The view, with the numbers of its corners; of length 0 where fewer than 8 are seen, or all
        on one line.

    Raises:
        InputError: The markers are not smaller than the squares, or too many for the dictionary.

    References:
        Garrido-Jurado et al., Automatic generation and detection of highly reliable fiducial
        markers under occlusion, Pattern Recognition 47(6), 2014.
    """
    if not 0 < markers.size < board.square:
        raise InputError(
            f"Markers of {markers.size * 1e3:g} mm do not fit into squares of "
            f"{board.square * 1e3:g} mm; give the side of a marker's black frame."
        )
    for is_legacy in (False, True):
        corners, numbers = _detect(photo, board, markers, is_legacy)
        if len(numbers) >= _MIN_CORNERS and _is_spread(numbers, board):
            return BoardView(
                name, _refine(photo, corners, numbers, board, markers), numbers=numbers
            )
    return BoardView(name, np.zeros((0, 2)))


def _detect(
    photo: Image, board: Chessboard, markers: Markers, is_legacy: bool
) -> tuple[Pixels, Indices]:
    """Let OpenCV find corners; boards printed by its old versions start with another colour."""
    dictionary = load_dictionary(markers.dictionary)
    size = (board.columns + 1, board.rows + 1)
    num_markers = size[0] * size[1] // 2
    if num_markers > len(dictionary.bytesList):
        raise InputError(
            f"A {board} board has {num_markers} markers, but {markers.dictionary} has only "
            f"{len(dictionary.bytesList)}; give the dictionary that it was printed with."
        )
    pattern = cv2.aruco.CharucoBoard(size, board.square, markers.size, dictionary)
    pattern.setLegacyPattern(is_legacy)
    corners, numbers, _, _ = cv2.aruco.CharucoDetector(pattern).detectBoard(photo)
    if numbers is None:
        return np.zeros((0, 2)), np.zeros(0, np.int64)
    return corners.reshape(-1, 2).astype(np.float64), numbers.ravel().astype(np.int64)


def _is_spread(numbers: Indices, board: Chessboard) -> bool:
    """Tell whether corners are in two rows and two columns at least."""
    rows, columns = np.divmod(numbers, board.columns)
    return len(np.unique(rows)) >= 2 and len(np.unique(columns)) >= 2


def _refine(
    photo: Image, corners: Pixels, numbers: Indices, board: Chessboard, markers: Markers
) -> Pixels:
    gap = (1 - markers.size / board.square) / 2 * _pitch(corners, numbers, board)
    half_width = int(np.clip(_SHARE * gap, 2, _WINDOW))
    stop = (cv2.TERM_CRITERIA_EPS | cv2.TERM_CRITERIA_COUNT, 50, 1e-4)
    start = np.ascontiguousarray(corners[:, None], dtype=np.float32)
    refined = cv2.cornerSubPix(photo, start, (half_width, half_width), (-1, -1), stop)
    return refined.reshape(-1, 2).astype(np.float64)


def _pitch(corners: Pixels, numbers: Indices, board: Chessboard) -> float:
    """Give the smallest distance of corners that are neighbours in a row [px]."""
    next_to = (np.diff(numbers) == 1) & (numbers[:-1] % board.columns < board.columns - 1)
    steps = np.linalg.norm(np.diff(corners, axis=0), axis=1)[next_to]
    return float(steps.min()) if len(steps) else 8.0 * _WINDOW
