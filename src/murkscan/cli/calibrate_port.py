"""murkscan calibrate port: find how the camera's port stands, in the water at hand."""

import math
from typing import Literal

from ..errors import InputError
from ..ui.calibration_values import read_measured
from .calibrate import parse_board
from .calibrate_result import print_result
from .paths import PhotoPath, RigFile
from .progress import progress_bars


def port(
    images: PhotoPath,
    *,
    board: str,
    square_mm: float,
    rig: RigFile,
    distance_mm: str | None = None,
    index_sigma: float = 2e-4,
    index: Literal["known", "free"] = "known",
    camera: Literal["known", "free"] = "known",
) -> None:
    """Find how the camera's port stands, from photos of a board under water.

    Parameters
    ----------
    images
        A folder of photos of the board through the port, or a video: 15 or more, near and far,
        tilted to every side.
    board
        Inner corners of the board, such as 9x6: where black squares touch, not squares.
    square_mm
        Side of a square [mm].
    rig
        The rig file, with its camera, [camera.port] as measured, and the [water] at hand.
    distance_mm
        From the optical centre to the port's inner face, with its standard deviation, such as
        30±2 [mm]; unless given, found from the photos alone.
    index_sigma
        Standard deviation of the water's index as [water] gives it; its error goes into the
        covariance.
    index
        known: as [water] gives it. free: found from the board's known size, and written.
    camera
        known: calibrated in air, and adjusted within its covariance. free: found from these
        photos too; say then how far the port is with --distance-mm.
    """
    chessboard = parse_board(board, square_mm)
    from ..survey.calibrate_port import PortKnowledge, calibrate_port_from_photos

    knowledge = PortKnowledge(
        distance=None if distance_mm is None else read_measured(distance_mm),
        index_sigma=_check_sigma(index_sigma),
        is_index_free=index == "free",
        is_camera_free=camera == "free",
    )
    with progress_bars() as progress:
        result = calibrate_port_from_photos(
            images, chessboard, rig, knowledge=knowledge, progress=progress
        )
    print_result(result, rig)


def _check_sigma(sigma: float) -> float:
    if not 0 <= sigma < 1 or not math.isfinite(sigma):
        raise InputError(f"--index-sigma must be a deviation of 0 or more, got {sigma:g}.")
    return sigma
