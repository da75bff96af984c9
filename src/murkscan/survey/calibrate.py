"""Calibrate a camera and its lasers from photos: find, fit, judge, save, draw."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

from ..calibrate.board import Chessboard
from ..calibrate.camera import CameraCalibration, calibrate_camera
from ..calibrate.charuco import Markers
from ..calibrate.story import Story
from ..calibrate.verdict import CalibrationVerdict, judge_camera
from ..errors import EstimationError, InputError
from ..io.rig_toml import read_tables, save_calibration
from .board_photos import BoardPhotos
from .board_views import find_boards
from .calibrate_drawing import draw_boards, write_page
from .calibration_record import record_camera, record_setting
from .progress import Progress, silent


@dataclass(frozen=True, eq=False)
class CameraResult:
    """What calibrating a camera gave."""

    calibration: CameraCalibration
    """The camera and what it is worth."""
    verdict: CalibrationVerdict
    """The same in plain words."""
    num_photos: int
    """Photos that could be read."""
    without_board: tuple[str, ...]
    """Photos in which the board was not found."""
    skipped: Mapping[str, str]
    """Photos that could not be read, and why."""
    pictures: Path
    """Folder of the photos with their corners drawn."""
    page: Path
    """The page that shows all of it."""


def calibrate_camera_from_photos(
    path: Path,
    board: Chessboard,
    rig_path: Path,
    *,
    wavelength: float = 532e-9,
    markers: Markers | None = None,
    progress: Progress = silent,
) -> CameraResult:
    """Calibrate a camera and write it to a rig file; the rest of the file stays.

    Args:
        path: A folder of photos of the board, or a video.
        board: The board.
        rig_path: The rig file; made where it is missing.
        wavelength: Of the laser [m]; written where the rig file has none.
        markers: The markers of a ChArUco board, of which a part is enough; None for a plain one.
        progress: Told of each photo.

    Raises:
        InputError: The rig's camera has a port, there are no photos, they differ in size, or they
            lie where the drawings go.
        FormatError: None of the photos can be read, or the rig file is none.
        NotEnoughData: The board was found in fewer than four photos.
        Degenerate: The photos do not determine the camera.
    """
    tables = _read_without_port(rig_path)
    photos, folder = open_photos(path, rig_path, "camera")
    views, size = find_boards(photos, board, progress, markers=markers)
    draw = partial(draw_boards, photos, views, folder, board=board, progress=progress)
    try:
        calibration = calibrate_camera(views, board, size)
    except EstimationError as error:
        draw(residuals={})
        raise type(error)(f"{error} The photos with their corners lie in {folder}.") from error
    verdict = judge_camera(calibration)
    record = record_setting(board, len(views), tables) | record_camera(calibration, verdict)
    found = replace(calibration.rig, wavelength=wavelength)
    save_calibration(rig_path, found, ["camera"], record=record)
    residuals = zip((view.name for view in calibration.views), calibration.residuals, strict=True)
    left_out = tuple(view.name for view in calibration.left_out)
    draw(residuals=dict(residuals), left_out=left_out)
    without = tuple(view.name for view in views if not view.is_found)
    adjusted = calibration.adjustment
    story = Story("Camera", adjusted, calibration.sightings(board), verdict, without)
    page = write_page(folder, story)
    return CameraResult(calibration, verdict, len(views), without, photos.skipped, folder, page)


def open_photos(path: Path, rig_path: Path, name: str) -> tuple[BoardPhotos, Path]:
    """Open the photos; give them, and the folder that the drawings of this calibration go to."""
    folder = rig_path.parent / "calibrate" / name
    if path.resolve().is_relative_to(folder.resolve()):
        raise InputError(
            f"The photos {path} lie in {folder}, where the drawings of this calibration go; move "
            "them to another folder."
        )
    return BoardPhotos.open(path), folder


def _read_without_port(rig_path: Path) -> dict[str, Any]:
    """Read the tables of a rig file, none where it is missing; refuse a camera behind a port."""
    tables = read_tables(rig_path) if rig_path.exists() else {}
    camera = tables.get("camera")
    if isinstance(camera, dict) and "port" in camera:
        raise InputError(
            f"The camera of {rig_path} has a port, and a camera is calibrated in air without one; "
            "take [camera.port] and [water] out, photograph in air, and put them back. Boards seen "
            "through the port are for `murkscan calibrate port`."
        )
    return tables
