"""The inner corners of a chessboard in a photo, to a small part of a pixel."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import product

import cv2
import numpy as np

from ..types.arrays import Image, Pixels
from .board import Chessboard
from .view import BoardView

_SB_FLAGS = cv2.CALIB_CB_NORMALIZE_IMAGE | cv2.CALIB_CB_EXHAUSTIVE | cv2.CALIB_CB_ACCURACY
_CLASSIC_FLAGS = cv2.CALIB_CB_NORMALIZE_IMAGE | cv2.CALIB_CB_ADAPTIVE_THRESH
_WINDOW = 0.3
"""Half width of the refinement window over the pitch: the next edge stays outside."""
_UNEVEN = 0.15
"""Bend of the grid, over the pitch, that no lens makes: a corner is at a wrong place."""


def find_board(photo: Image, board: Chessboard, *, name: str = "") -> BoardView:
    """Find a chessboard and refine its corners.

    The sector-based finder is tried first, then the classic one, then both on the photo at half
    size, which helps where it is out of focus. What a finder gives counts only if it is an even
    grid: either of them may put a corner of a board at the photo's edge into the wrong place.

    Args:
        photo: The photo, grey, 8 bit.
        board: The board looked for.
        name: Name of the photo.

    Returns:
        The view; its corners are of length 0 where the photo does not show the whole board. The
        first corner is at the dark corner square if just one end has one, otherwise the row of
        corners points to the right of the photo.

    References:
        Duda and Frese, Accurate detection and localization of checkerboard corners for
        calibration, BMVC 2018.
    """
    half = cv2.pyrDown(photo)
    for image, scale in ((photo, 1.0), (half, 2.0)):
        for find in (_find_by_sectors, _find_by_squares):
            corners = find(image, board)
            if len(corners) == 0:
                continue
            corners = _refine(photo, corners * scale, board)
            if _unevenness(corners, board) < _UNEVEN:
                return _orient(photo, corners, board, name)
    return BoardView(name, np.zeros((0, 2)))


def suggest_board(photos: Sequence[Image], board: Chessboard) -> Chessboard | None:
    """Find out which other board the photos show: one with a row or a column more or fewer.

    Squares are easily counted instead of corners. Gives None where no other board is found either.
    """
    for photo in photos:
        for columns, rows in product((-1, 0, 1), (-1, 0, 1)):
            if (columns, rows) == (0, 0) or min(board.columns + columns, board.rows + rows) < 3:
                continue
            other = replace(board, columns=board.columns + columns, rows=board.rows + rows)
            corners = _find_by_squares(photo, other)
            if len(corners) and _unevenness(corners, other) < _UNEVEN:
                return other
    return None


def _find_by_sectors(image: Image, board: Chessboard) -> Pixels:
    found, corners, _ = cv2.findChessboardCornersSBWithMeta(
        image, (board.columns, board.rows), _SB_FLAGS
    )
    return corners.reshape(-1, 2).astype(np.float64) if found else np.zeros((0, 2))


def _find_by_squares(image: Image, board: Chessboard) -> Pixels:
    found, corners = cv2.findChessboardCorners(
        image, (board.columns, board.rows), flags=_CLASSIC_FLAGS
    )
    return corners.reshape(-1, 2).astype(np.float64) if found else np.zeros((0, 2))


def _refine(photo: Image, corners: Pixels, board: Chessboard) -> Pixels:
    """Move each corner to where the edges cross, in a window that holds only its own edges."""
    half_width = int(max(_WINDOW * smallest_pitch(corners, board), 2))
    stop = (cv2.TERM_CRITERIA_EPS | cv2.TERM_CRITERIA_COUNT, 50, 1e-4)
    start = np.ascontiguousarray(corners[:, None], dtype=np.float32)
    refined = cv2.cornerSubPix(photo, start, (half_width, half_width), (-1, -1), stop)
    return refined.reshape(-1, 2).astype(np.float64)


def smallest_pitch(corners: Pixels, board: Chessboard) -> float:
    """Give the smallest distance of neighbouring corners [px]."""
    grid = corners.reshape(board.rows, board.columns, 2)
    steps = [np.linalg.norm(np.diff(grid, axis=axis), axis=2).min() for axis in (0, 1)]
    return float(min(steps))


def _unevenness(corners: Pixels, board: Chessboard) -> float:
    """Give the worst bend of the grid over its smallest pitch, perspective taken out.

    A lens bends a grid a little everywhere; a misplaced corner bends it a lot at one place.
    """
    pitch = smallest_pitch(corners, board)
    if pitch < 1.0:
        return np.inf
    flat = board.points()[:, :2]
    homography, _ = cv2.findHomography(flat, corners)
    if homography is None:
        return np.inf
    ideal = cv2.perspectiveTransform(flat[None], homography)[0]
    left_over = (corners - ideal).reshape(board.rows, board.columns, 2)
    bends = [np.linalg.norm(np.diff(left_over, 2, axis=axis), axis=2).max() for axis in (0, 1)]
    return float(max(bends)) / pitch


def _orient(photo: Image, corners: Pixels, board: Chessboard, name: str) -> BoardView:
    """Number the corners alike in every photo, as far as the pattern allows it."""
    grid = corners.reshape(board.rows, board.columns, 2)
    across, down = grid[0, -1] - grid[0, 0], grid[-1, 0] - grid[0, 0]
    if across[0] * down[1] - across[1] * down[0] < 0:
        grid = grid[:, ::-1]
    num_turns = 4 if board.rows == board.columns else 2
    turned = [np.rot90(grid, turn * 4 // num_turns) for turn in range(num_turns)]
    if (board.rows + board.columns) % 2 == 1:
        best = next((g for g in turned if _is_first_dark(photo, g)), turned[0])
    else:
        best = max(turned, key=lambda g: (g[0, -1] - g[0, 0])[0])
    return BoardView(name, np.ascontiguousarray(best).reshape(-1, 2), _is_first_dark(photo, best))


def _is_first_dark(photo: Image, grid: np.ndarray) -> bool:
    """Tell whether the square after the first corner, down and right, is dark.

    It has the colour of the one before, up and left, which may lie outside of the photo.
    """
    middles = (grid[:-1, :-1] + grid[1:, :-1] + grid[:-1, 1:] + grid[1:, 1:]) / 4
    u, v = np.round(middles).astype(int).reshape(-1, 2).T
    v, u = np.clip(v, 0, photo.shape[0] - 1), np.clip(u, 0, photo.shape[1] - 1)
    levels = photo[v, u].reshape(middles.shape[:2]).astype(float)
    sign = (-1.0) ** np.add.outer(np.arange(levels.shape[0]), np.arange(levels.shape[1]))
    return bool(levels[sign > 0].mean() < levels[sign < 0].mean())
