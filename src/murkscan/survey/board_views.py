"""The board in every photo of a calibration."""

from ..calibrate.board import Chessboard
from ..calibrate.charuco import Markers, find_charuco
from ..calibrate.corners import find_board, suggest_board
from ..calibrate.view import BoardView
from ..errors import InputError, NotEnoughData
from ..types.arrays import Image
from .board_photos import BoardPhotos
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
    """Look for the board in every photo; give the views, and the size of the photos.

    Args:
        photos: The photos.
        board: The board.
        progress: Told of each photo.
        size: Width and height that the photos must have [px]; None for any.
        markers: The markers of a ChArUco board; None for a plain one.

    Raises:
        InputError: The photos have another size, or differ in size.
        FormatError: None of the photos can be read.
        NotEnoughData: The board is in none of them.
    """
    views, seen, first = [], list[Image](), None
    for photo in photos:
        first = first or photo
        if size is not None and photo.size != size:
            raise InputError(
                f"{photos.path / photo.name} is {photo.size[0]} x {photo.size[1]} px but the rig's "
                f"camera has {size[0]} x {size[1]}; give photos of this camera, never resized."
            )
        grey = photo.as_grey()
        if markers is None:
            views.append(find_board(grey, board, name=photo.name))
        else:
            views.append(find_charuco(grey, board, markers, name=photo.name))
        if len(seen) < _SUGGEST_FROM:
            seen.append(grey)
        progress("find boards", len(views), photos.num_photos)
    assert first is not None
    if not any(view.is_found for view in views):
        raise NotEnoughData(_never_found(photos, board, len(views), seen, markers))
    return views, first.size


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
        f"None of the {num_photos} photos in {photos.path} shows a whole {board} board. Count its "
        "INNER corners, where black squares touch; show all of it, closer, sharp and evenly lit."
    )
