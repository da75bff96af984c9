"""Take photos of a board that is held before a live camera: by itself, or when asked to."""

from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..calibrate.board.chessboard import Chessboard
from ..calibrate.board.choosing import PhotoChooser
from ..calibrate.board.corners import find_board
from ..calibrate.board.spoiled import name_spoiler
from ..calibrate.board.view import BoardView
from ..capture.folder import list_pictures
from ..errors import FormatError
from ..io.images import write_image
from ..io.json_files import save_json
from ..types.arrays import Image
from .progress import Progress, silent

SIGHT = "sight"
"""Folder beside the photos for what the camera sees now: picture.jpg, and status.json about it.
Whoever puts a file `take` there asks for a photo of the next picture."""
_WORDS = {
    "take": "taken",
    "no board": "the board is not seen: show all of it, sharp and evenly lit",
    "moves": "hold it still",
    "is not sharp": "it is not sharp: mend the focus, or go farther",
    "is as before": "a photo like this is there: move it, tilt it, nearer or farther",
}


@dataclass(frozen=True)
class PhotosTaken:
    """What became of it."""

    names: tuple[str, ...]
    """The photos."""
    is_enough: bool
    """Whether there are as many as were asked for."""


def take_photos(
    pictures: Iterable[tuple[Image, float]],
    board: Chessboard,
    folder: Path,
    *,
    count: int,
    progress: Progress = silent,
) -> PhotosTaken:
    """Look at pictures as they come, and keep those in which the board is still, sharp and new.

    Args:
        pictures: Pictures with their times [s]; each is the newest there is.
        board: The board.
        folder: Where the photos go; those that are there stay.
        count: Photos after which it ends.
        progress: Told of each photo.

    Raises:
        DeviceError: The disk is full.
    """
    chooser, names = PhotoChooser(board), list[str]()
    progress("photographs", 0, count)
    for picture, time in pictures:
        image = _as_bytes(picture)
        view = find_board(image, board, name="now")
        judged = chooser.judge(view, image, time)
        if _is_asked(folder) or judged == "take":
            chooser.take(view)
            names.append(_keep(folder, image))
            judged = "take"
            progress("photographs", len(names), count)
        spoiler = name_spoiler(image, view, board)
        words = f"{_WORDS[judged]}; {spoiler}" if spoiler else _WORDS[judged]
        _show(folder, image, view, words, names, count)
        if len(names) >= count:
            return PhotosTaken(tuple(names), True)
    return PhotosTaken(tuple(names), False)


def _is_asked(folder: Path) -> bool:
    with suppress(OSError):
        (folder / SIGHT / "take").unlink()
        return True
    return False


def _keep(folder: Path, image: Image) -> str:
    """Write a photo without loss, by the first number that is free."""
    taken: set[str] = set()
    with suppress(FormatError, OSError):
        taken = set(list_pictures(folder))
    number = next(k for k in range(1, 100_000) if f"board{k:03d}.png" not in taken)
    write_image(folder / f"board{number:03d}.png", image)
    return f"board{number:03d}.png"


def _show(
    folder: Path, image: Image, view: BoardView, words: str, names: list[str], count: int
) -> None:
    write_image(folder / SIGHT / "picture.jpg", image)
    save_json(
        folder / SIGHT / "status.json",
        {
            "format": 1,
            "size": [image.shape[1], image.shape[0]],
            "corners_px": np.round(view.corners, 1).tolist(),
            "message": words,
            "taken": len(names),
            "wanted": count,
            "newest": names[-1] if names else "",
        },
    )


def _as_bytes(image: Image) -> Image:
    """Give a picture in 8 bit, as boards are looked for in."""
    return image if image.dtype == np.uint8 else (image >> 8).astype(np.uint8)
