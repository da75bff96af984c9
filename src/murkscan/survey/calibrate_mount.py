"""Calibrate where the camera sits on its vehicle, from photos of a board and a log of poses."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ..calibrate.board.chessboard import Chessboard
from ..calibrate.calibration import Calibration
from ..calibrate.mount import MeasuredPlace, calibrate_mount
from ..capture import open_recording
from ..capture.folder import list_pictures
from ..errors import InputError, MissingResult
from ..io.rig_toml import parse_rig, read_tables
from ..types.rig import Rig
from ..types.trajectory import Trajectory
from .calibrate import BoardSession, CalibrationResult, Fit, size_in
from .progress import Progress, silent


@dataclass(frozen=True)
class PhotoClock:
    """How the photos' times are told by the log's clock."""

    fps: float | None = None
    """Photos a second, for a folder without times.csv."""
    start_time: float = 0.0
    """Log time at which recording time is 0 [s]."""
    time_offset: float = 0.0
    """Added to recording times [s]."""


def calibrate_mount_from_photos(
    path: Path,
    board: Chessboard,
    rig_path: Path,
    log: Trajectory,
    *,
    clock: PhotoClock | None = None,
    measured: MeasuredPlace | None = None,
    progress: Progress = silent,
) -> CalibrationResult:
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
    tables, fit = plan_mount(rig_path, path, log, clock, measured)
    session = BoardSession.open(path, board, rig_path, "mount", tables=tables, progress=progress)
    session.find_boards(size=size_in(tables))
    found = session.solve(fit)
    result = session.finish(found, ["mount"], title="Mount")
    stand = found.adjustment.stand
    if found.clock_sigma is None or stand is None:
        remark = "The clock's offset is not determined: the vehicle stood still in the photos."
    else:
        offset = stand.clock_offset + clock.time_offset
        remark = (
            f"The clock: add {stand.clock_offset:+.4f} ± {found.clock_sigma:.2g} s to the photos' "
            f"times, so scan with --time-offset-s {offset:.4f}."
        )
    return replace(result, remarks=(remark, *result.remarks))


def plan_mount(
    rig_path: Path,
    path: Path,
    log: Trajectory,
    clock: PhotoClock,
    measured: MeasuredPlace | None = None,
) -> tuple[dict[str, Any], Fit]:
    """Read the rig file and the photos' times, and say how the mount is fitted.

    Raises:
        MissingResult: The camera has not been calibrated.
        InputError: The photos have no times.
        FormatError: The rig file is none.
    """
    tables = read_tables(rig_path)
    if "camera" not in tables:
        raise MissingResult(
            f"{rig_path} has no camera yet; run `murkscan calibrate camera` first with the same "
            "--rig."
        )
    rig = parse_rig(tables, name=str(rig_path))
    times = _read_times(path, rig, clock)

    def fit(session: BoardSession) -> Calibration:
        timed = [view for view in session.views if view.name in times]
        session.unused |= {v.name: "has no time" for v in session.views if v.name not in times}
        session.unused |= {
            view.name: "shows a board that the picture cuts off, so that it is not known which "
            "corners"
            for view in timed
            if not view.is_placed
        }
        moments = np.array([times[view.name] for view in timed])
        return calibrate_mount(timed, moments, log, session.board, rig, measured=measured)

    return tables, fit


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
