"""Calibrate where the camera sits on its vehicle, from photos of a board and a log of poses."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..calibrate.board import Chessboard
from ..calibrate.drawing import draw_board
from ..calibrate.hand_eye import MeasuredPlace, MountCalibration, calibrate_mount
from ..calibrate.mount_verdict import judge_mount
from ..calibrate.verdict import CalibrationVerdict
from ..calibrate.view import BoardView
from ..capture import open_recording
from ..capture.folder import list_pictures
from ..errors import EstimationError, InputError, MissingResult
from ..io.images import write_image
from ..io.rig_toml import parse_rig, read_tables, save_mount
from ..types.arrays import Pixels
from ..types.rig import Rig
from ..types.trajectory import Trajectory
from .board_photos import BoardPhotos
from .board_views import find_boards
from .calibration_record import record_setting
from .mount_record import record_mount
from .progress import Progress, silent

_SUFFIX = ".found.jpg"
"""Ends the names of our drawings, so that nothing else is ever taken for one."""


@dataclass(frozen=True)
class PhotoClock:
    """How the photos' times are told by the log's clock."""

    fps: float | None = None
    """Photos a second, for a folder without times.csv."""
    start_time: float = 0.0
    """Log time at which recording time is 0 [s]."""
    time_offset: float = 0.0
    """Added to recording times [s]."""


@dataclass(frozen=True, eq=False)
class MountResult:
    """What calibrating a mount gave."""

    calibration: MountCalibration
    """The mount and what it is worth."""
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
    time_offset: float | None
    """The offset to scan with [s]: the one given and the one found; None where none was found."""


def calibrate_mount_from_photos(
    path: Path,
    board: Chessboard,
    rig_path: Path,
    log: Trajectory,
    *,
    clock: PhotoClock | None = None,
    measured: MeasuredPlace | None = None,
    progress: Progress = silent,
) -> MountResult:
    """Calibrate the mount and write it to a rig file; the rest of the file stays.

    Args:
        path: A folder of photos of the board, which stands still, or a video.
        board: The board.
        rig_path: The rig file, with its camera.
        log: Poses world_from_vehicle.
        clock: How the photos' times are told by the log's clock.
        measured: Where the camera sits, as measured with a ruler.
        progress: Told of each photo.

    Raises:
        MissingResult: The camera has not been calibrated.
        InputError: The photos have no times, the log does not cover them or its clock is off, or
            they are not of the rig's size.
        FormatError: None of the photos can be read, or the rig file is none.
        NotEnoughData: The board was found in fewer than four photos.
        NotConverged: Log and photos do not belong together.
        Degenerate: The vehicle turned too little to tell the mount from.
    """
    clock = clock or PhotoClock()
    tables = read_tables(rig_path)
    if "camera" not in tables:
        raise MissingResult(
            f"{rig_path} has no camera yet; run `murkscan calibrate camera` first with the same "
            "--rig."
        )
    rig = parse_rig(tables, name=str(rig_path))
    photos, folder = BoardPhotos.open(path), rig_path.parent / "calibrate" / "mount"
    times_by_name = _read_times(path, rig, clock)
    views, _ = find_boards(photos, board, progress, size=rig.camera.size)
    views = [view for view in views if view.name in times_by_name]
    times = np.array([times_by_name[view.name] for view in views])
    try:
        calibration = calibrate_mount(views, times, log, board, rig, measured=measured)
    except EstimationError:
        _draw(photos, views, board, folder, None, progress)
        raise
    verdict = judge_mount(calibration)
    record = record_setting(board, len(views), tables) | record_mount(calibration, verdict)
    save_mount(rig_path, calibration.vehicle_from_camera, calibration.rig_covariance, record=record)
    _draw(photos, views, board, folder, calibration, progress)
    found = calibration.clock_offset
    return MountResult(
        calibration=calibration,
        verdict=verdict,
        num_photos=len(views),
        without_board=tuple(view.name for view in views if not view.is_found),
        skipped=photos.skipped,
        pictures=folder,
        time_offset=None if found is None else found + clock.time_offset,
    )


def _read_times(path: Path, rig: Rig, clock: PhotoClock) -> dict[str, float]:
    """Give the time of each photo by the log's clock [s]."""
    recording = open_recording(path, wavelength=rig.wavelength, fps=clock.fps, fields="progressive")
    if not recording.is_timed:
        raise InputError(
            f"The photos in {path} have no times, and without them the log does not say where the "
            "vehicle was: put a times.csv with the columns file,time_s beside them, or give --fps."
        )
    names = list_pictures(path) if path.is_dir() else None
    return {
        names[frame.index] if names else f"{path.stem}_{frame.index:06d}": (
            frame.time + clock.time_offset + clock.start_time
        )
        for frame in recording.frames()
    }


def _draw(
    photos: BoardPhotos,
    views: list[BoardView],
    board: Chessboard,
    folder: Path,
    calibration: MountCalibration | None,
    progress: Progress,
) -> None:
    """Draw the corners of every photo, with residuals where there is a calibration."""
    for file in folder.glob(f"*{_SUFFIX}"):
        file.unlink()
    by_name = {view.name: view for view in views}
    used = [] if calibration is None else [view.name for view in calibration.views]
    shown = (photo for photo in photos if photo.name in by_name)
    for done, photo in enumerate(shown):
        view = by_name[photo.name]
        residuals: Pixels = np.zeros((0, 2))
        note = f"{view.name}: {board} board" if view.is_found else f"{view.name}: no {board} board"
        if calibration is not None and view.name in used:
            number = used.index(view.name)
            residuals = calibration.residuals[number]
            note += f", closes to {calibration.closures[number] * 1e3:.2f} mm"
        elif calibration is not None and view.is_found:
            note += ", LEFT OUT: fits far worse than the others"
        picture = draw_board(photo.image, view, board, residuals, note)
        write_image(folder / f"{view.name}{_SUFFIX}", picture)
        progress("draw", done + 1, len(views))
