"""Calibrate a camera from photos of a board, in air."""

from dataclasses import replace
from pathlib import Path
from typing import Any

from ..calibrate.board.charuco import Markers
from ..calibrate.board.chessboard import Chessboard
from ..calibrate.calibration import Calibration
from ..calibrate.camera import calibrate_camera
from ..errors import InputError
from ..io.rig_toml import read_tables
from .calibrate import BoardSession, CalibrationResult
from .progress import Progress, silent


def calibrate_camera_from_photos(
    path: Path,
    board: Chessboard,
    rig_path: Path,
    *,
    wavelength: float = 532e-9,
    markers: Markers | None = None,
    progress: Progress = silent,
) -> CalibrationResult:
    """Calibrate a camera and write it to a rig file; the rest of the file stays.

    Args:
        path: A folder of photos of the board, or a video.
        board: The board.
        rig_path: The rig file; made where it is missing.
        wavelength: Of the laser [m]; written where the rig file has none.
        markers: The markers of a ChArUco board; None for a plain one.
        progress: Told of each photo.

    Raises:
        InputError: The rig's camera has a port, there are no photos, or they lie where the drawings
            go.
        FormatError: None of the photos can be read, or the rig file is none.
        NotEnoughData: The board was found in fewer than four photos.
        Degenerate: The photos do not determine the camera.
    """
    tables = _read_without_port(rig_path)
    session = BoardSession.open(path, board, rig_path, "camera", tables=tables, progress=progress)
    session.find_boards(markers=markers)
    found = session.solve(fit_camera)
    rig = replace(found.rig, wavelength=wavelength)
    found = replace(found, adjustment=replace(found.adjustment, rig=rig))
    return session.finish(found, ["camera"], title="Camera")


def fit_camera(session: BoardSession) -> Calibration:
    """Calibrate the camera on the boards that were found."""
    return calibrate_camera(session.views, session.board, session.size)


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
