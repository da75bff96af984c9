"""murkscan calibrate: find out what the camera and the laser are."""

import math
import re
from pathlib import Path
from typing import TYPE_CHECKING

from cyclopts import App

from ..errors import InputError
from .choices import ExtractorName, make_extractor
from .progress import progress_bars
from .words import print_table, say, say_verdict

if TYPE_CHECKING:
    from ..calibrate import Chessboard, Margin
    from ..survey.calibrate import CameraResult, LaserResult

app = App(name="calibrate", help="Find out what the camera and the laser are.")
app.command(
    "murkscan.cli.calibrate_port:port",
    name="port",
    help="Find how the camera's port stands, from photos of a board under water.",
)
app.command(
    "murkscan.cli.calibrate_mount:mount",
    name="mount",
    help="Find where the camera sits on the vehicle, from photos of a board that stands still.",
)


@app.command
def camera(
    images: Path, *, board: str, square_mm: float, rig: Path, wavelength_nm: float = 532.0
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
    wavelength_nm
        Wavelength of the laser [nm], for a new rig file.
    """
    chessboard = parse_board(board, square_mm)
    from ..survey.calibrate import calibrate_camera_from_photos

    with progress_bars() as progress:
        result = calibrate_camera_from_photos(
            images, chessboard, rig, wavelength=wavelength_nm * 1e-9, progress=progress
        )
    _print_camera(result, rig)


@app.command
def laser(
    images: Path,
    *,
    board: str,
    square_mm: float,
    rig: Path,
    margin_mm: str | None = None,
    laser: int = 0,
    extractor: ExtractorName = "gray-gravity",
) -> None:
    """Calibrate a laser on photos of its line on a chessboard, and write it to the rig file.

    Parameters
    ----------
    images
        A folder of photos of the line on the board, or a video: near, far, and between.
    board
        Inner corners of the board, such as 8x6: where black squares touch, not squares.
    square_mm
        Side of a square [mm].
    rig
        The rig file, with its camera. Its other tables and comments stay.
    margin_mm
        How far the flat paper runs on beyond the squares, as LEFT,RIGHT,TOP,BOTTOM [mm]; one
        square on each side unless given.
    laser
        Number of the laser that is new or replaced, from 0.
    extractor
        The way to find the stripe.
    """
    chessboard = parse_board(board, square_mm)
    margin = None if margin_mm is None else _margin(margin_mm)
    from ..survey.calibrate import calibrate_laser_from_photos

    with progress_bars() as progress:
        result = calibrate_laser_from_photos(
            images,
            chessboard,
            rig,
            margin=margin,
            laser=laser,
            extractor=make_extractor(extractor, ()),
            progress=progress,
        )
    _print_laser(result, rig, laser)


def parse_board(text: str, square_mm: float) -> "Chessboard":
    """Make the board of --board and --square-mm."""
    match = re.fullmatch(r"\s*(\d+)\s*[xX×]\s*(\d+)\s*", text)
    if match is None:
        raise InputError(
            f"--board {text!r} is not a board; give its inner corners as COLUMNSxROWS, such as 9x6."
        )
    from ..calibrate import Chessboard

    return Chessboard(int(match[1]), int(match[2]), square_mm / 1e3)


def _margin(text: str) -> "Margin":
    """Make the margin of --margin-mm."""
    try:
        sides = [float(side) / 1e3 for side in text.split(",")]
    except ValueError:
        sides = []
    if len(sides) != 4 or not all(math.isfinite(side) for side in sides):
        raise InputError(
            f"--margin-mm {text!r} is not LEFT,RIGHT,TOP,BOTTOM; give four numbers of millimetres, "
            "such as 120,80,60,60."
        )
    from ..calibrate import Margin

    return Margin(*sides)


def _print_camera(result: "CameraResult", rig: Path) -> None:
    from ..calibrate import PARAMETERS, coverage_of

    found = result.calibration
    values = [
        *found.camera.focal_length,
        *found.camera.principal_point,
        *found.camera.distortion.tolist(),
    ]
    print_table(
        "Camera",
        ("parameter", "value", "± 1σ", "unit"),
        [
            (name, f"{value:.4g}" if i > 3 else f"{value:.2f}", f"{sigma:.2g}", "px" * (i < 4))
            for i, (name, value, sigma) in enumerate(
                zip(PARAMETERS, values, found.sigma, strict=True)
            )
        ],
    )
    print_table(
        "Views",
        ("photo", "RMS [px]"),
        [(v.name, f"{rms:.3f}") for v, rms in zip(found.views, found.view_rms, strict=True)],
    )
    say(
        f"RMS {found.rms:.3f} px over {len(found.views)} views; corners in "
        f"{coverage_of(found).share:.0%} of the picture."
    )
    _say_photos(result, used=len(found.views))
    say_verdict(str(result.verdict), result.verdict.is_good)
    say(f"Written to {rig}; the photos with their corners lie in {result.pictures}.")


def _print_laser(result: "LaserResult", rig: Path, number: int) -> None:
    from ..calibrate import distances_of

    found = result.calibration
    baseline, angle = found.laser.as_baseline_angle()
    nearest, farthest = distances_of(found)
    n, d = found.sheet.normal, found.sheet.distance
    print_table(
        f"Laser {number}",
        ("what", "value"),
        [
            ("sheet", f"{n[0]:+.6f} X {n[1]:+.6f} Y {n[2]:+.6f} Z {d * 1e3:+.3f} mm = 0"),
            ("direction, ± 1σ", f"{math.degrees(found.angle_sigma):.3f} degrees"),
            ("axis", found.laser.axis),
            ("equivalent b", f"{baseline * 1e3:.2f} mm"),
            ("equivalent θ", f"{math.degrees(angle):.3f} degrees"),
            ("distances", f"{nearest * 1e3:.0f} to {farthest * 1e3:.0f} mm"),
        ],
    )
    print_table(
        "Photos",
        ("photo", "points", "RMS [mm]"),
        [
            (s.name, str(len(s.pixels)), f"{rms * 1e3:.3f}")
            for s, rms in zip(found.stripes, found.view_rms, strict=True)
        ],
    )
    say(
        f"RMS {found.rms * 1e3:.3f} mm over {found.num_inliers} of {found.num_points} stripe "
        f"points; {found.num_points - found.num_inliers} lay off the sheet and were left out."
    )
    _say_photos(result, used=len(found.stripes))
    if result.without_stripe:
        say(
            f"{len(result.without_stripe)} photos show a board but no stripe on its paper; "
            "--margin-mm says how far the paper runs on."
        )
    say_verdict(str(result.verdict), result.verdict.is_good)
    say(f"Written to {rig}; the photos with their stripes lie in {result.pictures}.")


def _say_photos(result: "CameraResult | LaserResult", *, used: int) -> None:
    words = f"{used} of {result.num_photos} photos used"
    if result.without_board:
        words += f"; {len(result.without_board)} without a whole board"
    say(words + ".")
    for reason in result.skipped.values():
        say(f"Skipped: {reason}")
