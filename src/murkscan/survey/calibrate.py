"""Calibrate a camera and its lasers from photos: find, fit, judge, save, draw."""

import datetime
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..calibrate.board import Chessboard, Margin
from ..calibrate.camera import CameraCalibration, calibrate_camera
from ..calibrate.corners import find_board, suggest_board
from ..calibrate.sheet import LaserCalibration, calibrate_laser
from ..calibrate.verdict import Verdict, judge_camera, judge_laser, name_sigma
from ..calibrate.view import BoardView
from ..errors import EstimationError, InputError, MissingResult, NotEnoughData
from ..extract import AbstractExtractor, GrayGravity
from ..io.rig_toml import load_rig, save_camera, save_laser
from ..types.arrays import Image
from ..types.rig import Rig
from .board_photos import BoardPhotos
from .board_stripes import StripeFinder
from .calibrate_drawing import draw_boards, draw_stripes
from .progress import Progress, silent

_SUGGEST_FROM = 4
"""Photos in which another board is looked for when the one asked for is nowhere."""


@dataclass(frozen=True, eq=False)
class CameraResult:
    """What calibrating a camera gave."""

    calibration: CameraCalibration
    """The camera and what it is worth."""
    verdict: Verdict
    """The same in plain words."""
    num_photos: int
    """Photos that could be read."""
    without_board: tuple[str, ...]
    """Photos in which the board was not found."""
    skipped: Mapping[str, str]
    """Photos that could not be read, and why."""
    pictures: Path
    """Folder of the photos with their corners drawn."""


@dataclass(frozen=True, eq=False)
class LaserResult:
    """What calibrating a laser gave."""

    calibration: LaserCalibration
    """The laser and what it is worth."""
    verdict: Verdict
    """The same in plain words."""
    num_photos: int
    """Photos that could be read."""
    without_board: tuple[str, ...]
    """Photos in which the board was not found."""
    without_stripe: tuple[str, ...]
    """Photos with a board but no stripe on its paper."""
    skipped: Mapping[str, str]
    """Photos that could not be read, and why."""
    pictures: Path
    """Folder of the photos with their stripes drawn."""


def calibrate_camera_from_photos(
    path: Path,
    board: Chessboard,
    rig_path: Path,
    *,
    wavelength: float = 532e-9,
    progress: Progress = silent,
) -> CameraResult:
    """Calibrate a camera and write it to a rig file; the rest of the file stays.

    Args:
        path: A folder of photos of the board, or a video.
        board: The board.
        rig_path: The rig file; made where it is missing.
        wavelength: Of the laser [m]; written where the rig file has none.
        progress: Told of each photo.

    Raises:
        InputError: There are no photos, or they differ in size.
        FormatError: None of the photos can be read, or the rig file is none.
        NotEnoughData: The board was found in fewer than four photos.
        Degenerate: The photos do not determine the camera.
    """
    photos = BoardPhotos.open(path)
    views, size = _find_boards(photos, board, progress)
    folder = rig_path.parent / "calibrate" / "camera"
    try:
        calibration = calibrate_camera(views, board, size)
    except EstimationError as error:
        draw_boards(photos, views, board, None, folder, progress)
        raise type(error)(f"{error} The photos with their corners lie in {folder}.") from error
    verdict = judge_camera(calibration)
    without = tuple(view.name for view in views if not view.is_found)
    record = _record(board, len(views), str(verdict)) | {
        "views": len(calibration.views),
        "left_out": [view.name for view in calibration.left_out],
        "rms_px": round(calibration.rms, 4),
        "view_rms_px": [round(rms, 4) for rms in calibration.view_rms],
        "sigma": {name: float(f"{s:.4g}") for name, s in name_sigma(calibration).items()},
    }
    save_camera(rig_path, calibration.camera, wavelength=wavelength, record=record)
    draw_boards(photos, views, board, calibration, folder, progress)
    return CameraResult(calibration, verdict, len(views), without, photos.skipped, folder)


def calibrate_laser_from_photos(
    path: Path,
    board: Chessboard,
    rig_path: Path,
    *,
    margin: Margin | None = None,
    laser: int = 0,
    extractor: AbstractExtractor | None = None,
    progress: Progress = silent,
) -> LaserResult:
    """Calibrate the sheet of a laser and write it to a rig file; the rest of the file stays.

    Args:
        path: A folder of photos of the laser's line on the board, or a video.
        board: The board.
        rig_path: The rig file, with its camera.
        margin: How far the board's flat paper runs on beyond its squares; unless given, one square.
        laser: Number of the laser that is new or replaced.
        extractor: The way to find the stripe; gray gravity unless given.
        progress: Told of each photo.

    Raises:
        MissingResult: The camera has not been calibrated.
        InputError: The number of the laser leaves a gap, there are no photos, or they are not of
            the rig's size.
        FormatError: None of the photos can be read, or the rig file is none.
        NotEnoughData: Fewer than two photos show the board and the stripe.
        Degenerate: The boards stood nearly in one place.
    """
    rig = _load_calibrated(rig_path, laser)
    photos = BoardPhotos.open(path)
    views, _ = _find_boards(photos, board, progress, rig.camera.size)
    margin = margin or Margin(board.square, board.square, board.square, board.square)
    finder = StripeFinder(photos, views, board, margin, rig, extractor or GrayGravity())
    stripes = finder.find(progress)
    folder = rig_path.parent / "calibrate" / f"laser_{laser}"
    drawn = (photos, board, margin, rig.camera, folder, progress)
    try:
        calibration = calibrate_laser(stripes, rig.camera)
    except EstimationError as error:
        draw_stripes(stripes, None, *drawn)
        raise type(error)(f"{error} The photos with their stripes lie in {folder}.") from error
    verdict = judge_laser(calibration)
    record = _record(board, len(views), str(verdict)) | {
        "views": len(calibration.stripes),
        "points": calibration.num_points,
        "inliers": calibration.num_inliers,
        "rms_mm": round(calibration.rms * 1e3, 4),
        "view_rms_mm": [round(rms * 1e3, 4) for rms in calibration.view_rms],
        "angle_sigma_deg": float(f"{np.degrees(calibration.angle_sigma):.4g}"),
    }
    save_laser(rig_path, calibration.laser, laser, record=record)
    draw_stripes(stripes, calibration, *drawn)
    return LaserResult(
        calibration=calibration,
        verdict=verdict,
        num_photos=len(views),
        without_board=tuple(view.name for view in views if not view.is_found),
        without_stripe=tuple(stripe.name for stripe in stripes if len(stripe.pixels) == 0),
        skipped=photos.skipped,
        pictures=folder,
    )


def _find_boards(
    photos: BoardPhotos,
    board: Chessboard,
    progress: Progress,
    size: tuple[int, int] | None = None,
) -> tuple[list[BoardView], tuple[int, int]]:
    """Look for the board in every photo; give the views, and the size of the photos."""
    views, seen, first = [], list[Image](), None
    for photo in photos:
        first = first or photo
        if size is not None and photo.size != size:
            raise InputError(
                f"{photos.path / photo.name} is {photo.size[0]} x {photo.size[1]} px but the rig's "
                f"camera has {size[0]} x {size[1]}; give photos of this camera, never resized."
            )
        grey = photo.as_grey()
        views.append(find_board(grey, board, name=photo.name))
        if len(seen) < _SUGGEST_FROM:
            seen.append(grey)
        progress("find boards", len(views), photos.num_photos)
    assert first is not None
    if not any(view.is_found for view in views):
        raise NotEnoughData(_never_found(photos, board, len(views), seen))
    return views, first.size


def _never_found(photos: BoardPhotos, board: Chessboard, num_photos: int, seen: list[Image]) -> str:
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


def _load_calibrated(rig_path: Path, laser: int) -> Rig:
    """Load a rig that has a camera, and room for the laser."""
    if not rig_path.exists() or _has_no_camera(rig_path):
        raise MissingResult(
            f"{rig_path} has no camera yet; run `murkscan calibrate camera` first with the same "
            "--rig."
        )
    rig = load_rig(rig_path)
    if rig.camera.port is not None:
        raise InputError(
            f"The camera of {rig_path} has a port, and a laser can be calibrated in air without "
            "one only; take [camera.port] out, photograph in air, and put it back."
        )
    if not 0 <= laser <= len(rig.lasers):
        raise InputError(
            f"{rig_path} has {len(rig.lasers)} laser(s), numbered from 0, so --laser may be "
            f"0 to {len(rig.lasers)}, not {laser}."
        )
    return rig


def _has_no_camera(rig_path: Path) -> bool:
    try:
        return "camera" not in tomllib.loads(rig_path.read_text("utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, IsADirectoryError):
        return False  # Not a rig file at all: `load_rig` says so better.


def _record(board: Chessboard, num_photos: int, verdict: str) -> dict[str, Any]:
    return {
        "date": datetime.date.today(),
        "board": str(board),
        "square_mm": round(board.square * 1e3, 6),
        "photos": num_photos,
        "verdict": verdict,
    }
