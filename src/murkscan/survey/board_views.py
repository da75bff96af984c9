"""The board in every photo of a calibration."""

from collections import Counter

import numpy as np

from ..calibrate.board.charuco import Markers, find_charuco
from ..calibrate.board.chessboard import Chessboard
from ..calibrate.board.corners import find_board, suggest_board
from ..calibrate.board.view import BoardView
from ..capture.photos import BoardPhotos
from ..errors import InputError, NotEnoughData
from ..types.arrays import Image
from .progress import Progress

_SUGGEST_FROM = 4
"""Photos in which another board is looked for when the one asked for is nowhere."""


def find_boards(
    photos: BoardPhotos,
    board: Chessboard,
    progress: Progress,
    *,
    size: tuple[int, int] | None = None,
    markers: Markers | None = None,
) -> tuple[list[BoardView], tuple[int, int]]:
    """Look for the board in every photo.

    Photos of another size than the rig's, or than most that show the board, are of another camera
    and are passed over.

    Args:
        photos: The photos.
        board: The board.
        progress: Told of each photo.
        size: Width and height that the photos must have [px]; None for any.
        markers: The markers of a ChArUco board; None for a plain one.

    Returns:
        The view of each photo, with a reason where there is no board, and the photos' size.

    Raises:
        InputError: All photos have another size than the rig's.
        FormatError: None of the photos can be read.
        NotEnoughData: The board is in none of them.
    """
    views, sizes, seen = list[BoardView](), list[tuple[int, int]](), list[Image]()
    for photo in photos:
        grey = photo.as_grey()
        if markers is None:
            views.append(find_board(grey, board, name=photo.name))
        else:
            views.append(find_charuco(grey, board, markers, name=photo.name))
        sizes.append(photo.size)
        if len(seen) < _SUGGEST_FROM:
            seen.append(grey)
        progress("find boards", len(views), photos.num_photos)
    found = [s for view, s in zip(views, sizes, strict=True) if view.is_found]
    wanted = size or Counter(found or sizes).most_common(1)[0][0]
    if wanted not in sizes:
        raise InputError(
            f"The photos in {photos.path} are {sizes[0][0]} x {sizes[0][1]} px but the rig's "
            f"camera has {wanted[0]} x {wanted[1]}; give photos of this camera, never resized."
        )
    views = [
        view if own == wanted else _of_another_camera(view, own, wanted)
        for view, own in zip(views, sizes, strict=True)
    ]
    if not any(view.is_found for view in views):
        raise NotEnoughData(_never_found(photos, board, len(views), seen, markers))
    return views, wanted


def _of_another_camera(
    view: BoardView, size: tuple[int, int], wanted: tuple[int, int]
) -> BoardView:
    reason = f"is {size[0]} x {size[1]} px, not {wanted[0]} x {wanted[1]} as this camera's photos"
    return BoardView(view.name, np.zeros((0, 2)), reason=reason)


def _never_found(
    photos: BoardPhotos,
    board: Chessboard,
    num_photos: int,
    seen: list[Image],
    markers: Markers | None,
) -> str:
    if markers is not None:
        return (
            f"None of the {num_photos} photos in {photos.path} shows markers {markers.dictionary} "
            f"of a {board} ChArUco board. Check the dictionary and the board's INNER corners, and "
            "show it closer, sharp and evenly lit."
        )
    other = suggest_board(seen, board)
    if other is not None:
        return (
            f"None of the {num_photos} photos in {photos.path} shows a {board} board, but a "
            f"{other} board is there: use --board {other}; INNER corners count, not squares."
        )
    return (
        f"None of the {num_photos} photos in {photos.path} shows a {board} board. Count its "
        "INNER corners, where black squares touch; show it closer, sharp and evenly lit."
    )
