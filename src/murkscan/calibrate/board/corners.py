"""The inner corners of a chessboard in a photo, to a small part of a pixel."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import cv2
import numpy as np
from jaxtyping import Float
from scipy import ndimage

from ...types.arrays import Image, Pixels
from .chessboard import Chessboard
from .lattice import Lattice, find_saddles, grow_lattice
from .refine import LEAST_CORNERS, Grid, refine_corners, smallest_pitch
from .spoiled import is_cut_off, name_spoiler
from .view import BoardView

_NUM_SCALES = 4
"""Sizes of the photo at which corners are looked for, each half of the one before: blurred corners
show on small ones."""
_SMALLEST = 100
"""Height or width below which a photo is not made smaller [px]."""
_LARGE = 1_500_000
"""Pixels from which a photo is looked at in half its size first."""
_LEAST_SIDE = 3
"""Rows and columns that a part of a board has at least."""
_INSIDE = 0.75
"""Share of the places where a missing row would be that lie in the picture, from which the board
does not end at the picture's edge, but is another one."""

Step = Float[np.ndarray, "2"]
"""From one corner to another [px]."""


def find_board(photo: Image, board: Chessboard, *, name: str = "") -> BoardView:
    """Find a chessboard, or as much of it as the picture shows, and refine its corners.

    Corners that a hand or a laser's line hides are left out. Where the picture's edge cuts the
    board, which of its corners are seen is not known; any of those that it may be are given, which
    is as good for a camera.

    Args:
        photo: The photo, grey, 8 bit.
        board: The board looked for.
        name: Name of the photo.

    Returns:
        The view; its corners are of length 0 where the photo does not show the board, with the
        reason, and what spoils the photo, if that is seen. The first corner is at the dark corner
        square if just one end has one, otherwise the row of corners points to the right of the
        photo.
    """
    view = _look_for(photo, board, name)
    spoiler = "" if view.is_found else name_spoiler(photo, view, board)
    return replace(view, reason=f"{view.reason}: {spoiler}") if spoiler else view


def _look_for(photo: Image, board: Chessboard, name: str) -> BoardView:
    best, reason = np.zeros((0, 0, 2)), "shows no chessboard"
    for image, scale in _scales(photo):
        lattice = grow_lattice(find_saddles(image), board.num_corners)
        grid = _keep_squares(refine_corners(photo, _fit_window(lattice, board) * scale))
        if np.isfinite(grid).sum() > np.isfinite(best).sum():
            best = grid
        if np.isfinite(grid[..., 0]).sum() == board.num_corners:
            break
    seen = int(np.isfinite(best[..., 0]).sum())
    if seen == 0:
        return BoardView(name, np.zeros((0, 2)), reason=reason)
    rows, columns = best.shape[:2]
    if min(rows, columns) < _LEAST_SIDE or seen < LEAST_CORNERS:
        reason = f"shows only {seen} corners of the {board} board"
        if is_cut_off(best[np.isfinite(best[..., 0])], smallest_pitch(best), photo.shape):
            reason += ", since the picture's edge cuts it off: show all of it"
        return BoardView(name, np.zeros((0, 2)), reason=reason)
    grid, is_first_dark = _orient(photo, best, board)
    if grid.size == 0:
        reason = (
            f"shows {columns}x{rows} corners of the {board} board, and not at the picture's edge"
        )
        return BoardView(name, np.zeros((0, 2)), reason=reason)
    numbers = np.flatnonzero(np.isfinite(grid[..., 0]).ravel())
    corners = grid.reshape(-1, 2)[numbers]
    return BoardView(
        name,
        corners,
        is_first_dark,
        None if len(numbers) == board.num_corners else numbers,
        is_placed={rows, columns} == {board.rows, board.columns},
    )


def suggest_board(photos: Sequence[Image], board: Chessboard) -> Chessboard | None:
    """Find out which other board the photos show; None where they show none, or several."""
    shapes = Counter[tuple[int, int]]()
    for photo in photos:
        for image, _ in _scales(photo):
            lattice = grow_lattice(find_saddles(image), 10 * board.num_corners)
            columns, rows = lattice.shape
            if min(columns, rows) >= _LEAST_SIDE and len(lattice.pixels) == columns * rows:
                shapes[max(columns, rows), min(columns, rows)] += 1
    if not shapes:
        return None
    (columns, rows), _ = shapes.most_common(1)[0]
    if board.columns < board.rows:
        columns, rows = rows, columns
    return replace(board, columns=columns, rows=rows)


def square_middles(grid: Grid) -> tuple[Pixels, np.ndarray]:
    """Find the middles of the squares between four corners [px], and which have the first's colour.

    Returns:
        The middles, and whether each square is of the colour of the one after the first corner,
        down and right.
    """
    middles = (grid[:-1, :-1] + grid[1:, :-1] + grid[:-1, 1:] + grid[1:, 1:]) / 4
    alike = np.add.outer(np.arange(middles.shape[0]), np.arange(middles.shape[1])) % 2 == 0
    known = np.isfinite(middles[..., 0])
    return middles[known], alike[known]


def _scales(photo: Image) -> list[tuple[np.ndarray, float]]:
    """Make the photo smaller and smaller; a large one counts in half its size first."""
    images = [(photo, 1.0)]
    while len(images) < _NUM_SCALES and min(images[-1][0].shape) >= 2 * _SMALLEST:
        images.append((cv2.pyrDown(images[-1][0]), 2 * images[-1][1]))
    if photo.size > _LARGE:
        images[:2] = images[1::-1]
    return images


def _fit_window(lattice: Lattice, board: Chessboard) -> Grid:
    """Lay the lattice out as rows and columns: the part not larger than the board that has most."""
    columns, rows = lattice.shape
    grid = np.full((rows, columns, 2), np.nan)
    grid[lattice.places[:, 1], lattice.places[:, 0]] = lattice.pixels
    candidates = []
    for width, height in {(board.columns, board.rows), (board.rows, board.columns)}:
        for left in range(max(columns - width, 0) + 1):
            for top in range(max(rows - height, 0) + 1):
                candidates.append(grid[top : top + height, left : left + width])
    return max(candidates, key=lambda part: np.isfinite(part).sum())


def _orient(photo: Image, grid: Grid, board: Chessboard) -> tuple[Grid, bool]:
    """Number the corners alike in every photo, as far as the pattern allows it.

    Returns:
        The grid of the whole board, and whether its first square is dark; empty where the board
        does not fit, or where what is missing would be in the picture.
    """
    across, down = _directions(grid)
    if across[0] * down[1] - across[1] * down[0] < 0:
        grid = grid[:, ::-1]
    fits = []
    for turns in range(4):
        turned = np.rot90(grid, turns)
        for top, left in _offsets(turned, board, photo.shape):
            whole = np.full((board.rows, board.columns, 2), np.nan)
            whole[top : top + turned.shape[0], left : left + turned.shape[1]] = turned
            is_first_dark = _is_first_dark(photo, whole)
            fits.append((whole, is_first_dark, _directions(turned)[0][0]))
    if not fits:
        return np.zeros((0, 0, 2)), True
    if (board.rows + board.columns) % 2 == 1:
        # One end has the dark corner square; a part of a board fits in several places.
        fits = [fit for fit in fits if fit[1]] or fits
    whole, is_first_dark, _ = max(fits, key=lambda fit: fit[2])
    return whole, is_first_dark


def _keep_squares(grid: Grid) -> Grid:
    """Leave out corners that are of no whole square: cloth gives scattered ones."""
    in_squares = ndimage.binary_opening(np.isfinite(grid[..., 0]), np.ones((2, 2), bool))
    return np.where(in_squares[..., None], grid, np.nan)


def _directions(grid: Grid) -> tuple[Step, Step]:
    """Compute the mean steps along the rows and down the columns [px]."""
    return (
        np.nanmean(np.diff(grid, axis=1), axis=(0, 1)),
        np.nanmean(np.diff(grid, axis=0), axis=(0, 1)),
    )


def _offsets(grid: Grid, board: Chessboard, shape: tuple[int, ...]) -> list[tuple[int, int]]:
    """List the rows and columns of the board at which a grid may begin; none if it cannot be."""
    rows, columns = grid.shape[:2]
    if rows > board.rows or columns > board.columns:
        return []
    tops = _starts(grid, board.rows - rows, shape)
    lefts = _starts(grid.transpose(1, 0, 2), board.columns - columns, shape)
    return [(top, left) for top in tops for left in lefts]


def _starts(grid: Grid, missing: int, shape: tuple[int, ...]) -> list[int]:
    """List how many of the missing rows may lie before the first one: those out of the picture."""
    if missing == 0:
        return [0]
    may_be_before = not _is_inside(2 * grid[0] - grid[1], shape)
    may_be_behind = not _is_inside(2 * grid[-1] - grid[-2], shape)
    if may_be_before and may_be_behind:
        return list(range(missing + 1))
    return [missing] if may_be_before else [0] if may_be_behind else []


def _is_inside(places: Float[np.ndarray, "n 2"], shape: tuple[int, ...]) -> bool:
    """Tell whether a row of places would be seen in a photo."""
    known = places[np.isfinite(places[:, 0])]
    if len(known) == 0:
        return False
    inside = ((known >= 0) & (known <= [shape[1] - 1, shape[0] - 1])).all(axis=1)
    return bool(inside.mean() > _INSIDE)


def _is_first_dark(photo: Image, grid: Grid) -> bool:
    """Tell whether the square after the first corner, down and right, is dark.

    It has the colour of the one before, up and left, which may lie outside of the photo.
    """
    middles, alike = square_middles(grid)
    u, v = np.round(middles).astype(int).T
    v, u = np.clip(v, 0, photo.shape[0] - 1), np.clip(u, 0, photo.shape[1] - 1)
    levels = photo[v, u].astype(float)
    if alike.all() or not alike.any():
        return True
    return bool(levels[alike].mean() < levels[~alike].mean())
