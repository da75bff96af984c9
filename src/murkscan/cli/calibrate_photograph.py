"""murkscan calibrate photograph: photos of a board from a live camera."""

from collections.abc import Generator
from contextlib import closing
from pathlib import Path
from shlex import quote
from typing import Annotated

from cyclopts import Parameter, validators
from cyclopts.types import PositiveFloat

from .calibrate import parse_board
from .progress import progress_bars
from .words import tell


def photograph(
    source: str,
    folder: Path,
    *,
    board: str,
    boards: Annotated[int, Parameter(validator=validators.Number(gte=1, lte=300))] = 15,
    wavelength_nm: PositiveFloat = 532.0,
    timeout: Annotated[
        PositiveFloat, Parameter(name="--timeout-s", validator=validators.Number(lte=86400))
    ] = 10.0,
) -> None:
    """Take photos of a board that you hold before a live camera, by itself.

    A photo is taken whenever the board is still, sharp, and held otherwise than before. What the
    camera sees is in FOLDER/sight, the whole recording in FOLDER/video. Ctrl-C ends it.

    Parameters
    ----------
    source
        An address (udp://, rtp://, rtsp:// ...), an SDP file, or a camera: its number, or
        /dev/video and its number.
    folder
        Folder for the photos; those that are there stay.
    board
        Inner corners of the board, such as 9x6: where black squares touch, not squares.
    boards
        Number of photos after which it ends.
    wavelength_nm
        Wavelength for which colours are weighted [nm].
    timeout
        Longest wait for the stream and for its next picture [s].
    """
    chessboard = parse_board(board, 10.0)  # of what size its squares are changes nothing here
    from ..capture.folder import list_pictures
    from ..survey.newest_pictures import NewestPictures
    from ..survey.photograph import take_photos

    pictures: Generator[tuple, None, None] = iter(  # type: ignore[type-arg]
        NewestPictures(source, folder / "video", wavelength=wavelength_nm * 1e-9, timeout=timeout)
    )
    try:
        with closing(pictures), progress_bars() as progress:
            take_photos(pictures, chessboard, folder, count=boards, progress=progress)
    except KeyboardInterrupt:
        tell("note", "ended by hand; the photos that were taken are kept")
    number = len(list_pictures(folder)) if any(folder.glob("board*.png")) else 0
    tell("made", f"{number} photos in {folder}")
    tell(
        "next",
        f"murkscan calibrate camera {quote(str(folder))} --board {board} --square-mm S "
        "--rig rig.toml",
    )
