"""murkscan calibrate: find out what the camera and the laser are."""

import re
from pathlib import Path
from typing import TYPE_CHECKING

from cyclopts import App

from ..errors import InputError
from .calibrate_result import print_result
from .paths import PhotoPath
from .progress import progress_bars

if TYPE_CHECKING:
    from ..calibrate import Chessboard

_LEAST_SQUARE, _MOST_SQUARE = 0.5, 1000.0
"""Sides of squares that a board can have [mm]; what lies outside was meant in another unit."""

app = App(
    name="calibrate",
    help="Find out what the camera and the laser are.",
    suppress_keyboard_interrupt=False,
)
for _place, (_name, _help) in enumerate(
    {
        "port": "Find how the camera's port stands, from photos of a board under water.",
        "laser": "Calibrate a laser on photos of its line on a board, in air or under water.",
        "mount": "Find where the camera sits on the vehicle, from photos of a still board.",
        "check": "Measure a known length in the scan's own water: is the rig right?",
        "photograph": "Take photos of a board from a live camera, by itself.",
        "describe": "Write what a data sheet, a ruler and a thermometer say into a rig file.",
        "board": "Draw a chessboard of the right size to print.",
    }.items()
):
    app.command(
        f"murkscan.cli.calibrate_{_name}:{_name}", name=_name, help=_help, sort_key=_place + 1
    )


@app.command(sort_key=0)
def camera(
    images: PhotoPath,
    *,
    board: str,
    square_mm: float,
    rig: Path,
    charuco_marker_mm: float | None = None,
    charuco_dictionary: str = "4X4_50",
    wavelength_nm: float = 532.0,
) -> None:
    """Calibrate the camera on photos of a chessboard, and write it to the rig file.

    Parameters
    ----------
    images
        A folder of photos of the board, or a video: 15 or more, tilted to every side.
    board
        Inner corners of the board, such as 9x6: where black squares touch, not squares.
    square_mm
        Side of a square [mm].
    rig
        The rig file; made where it is missing. Its other tables and comments stay.
    charuco_marker_mm
        Side of a marker of a ChArUco board [mm], of which a part is enough; not given for a plain
        chessboard.
    charuco_dictionary
        The markers that the ChArUco board was printed with, as OpenCV calls them.
    wavelength_nm
        Wavelength of the laser [nm], for a new rig file.
    """
    chessboard = parse_board(board, square_mm)
    markers = None
    if charuco_marker_mm is not None:
        from ..calibrate.board.charuco import Markers

        markers = Markers(charuco_marker_mm / 1e3, charuco_dictionary)
    from ..survey.calibrate_camera import calibrate_camera_from_photos

    with progress_bars() as progress:
        result = calibrate_camera_from_photos(
            images,
            chessboard,
            rig,
            wavelength=wavelength_nm * 1e-9,
            markers=markers,
            progress=progress,
        )
    print_result(result, rig)


def parse_board(text: str, square_mm: float) -> "Chessboard":
    """Make the board of --board and --square-mm."""
    match = re.fullmatch(r"\s*(\d+)\s*[xX×]\s*(\d+)\s*", text)
    if match is None:
        raise InputError(
            f"--board {text!r} is not a board; give its inner corners as COLUMNSxROWS, such as 9x6."
        )
    if 0 < square_mm < _LEAST_SQUARE or square_mm > _MOST_SQUARE:
        raise InputError(
            f"--square-mm {square_mm:g} cannot be: squares are {_LEAST_SQUARE:g} to "
            f"{_MOST_SQUARE:g} mm wide. Give millimetres, such as 30 for 0.03 m."
        )
    from ..calibrate import Chessboard

    return Chessboard(int(match[1]), int(match[2]), square_mm / 1e3)
