"""murkscan calibrate mount: where the camera sits on the vehicle."""

from typing import TYPE_CHECKING

from ..errors import InputError
from ..ui.values import read_numbers, read_start_time
from .calibrate import parse_board
from .calibrate_result import print_result
from .paths import LogPath, PhotoPath, RigFile
from .progress import progress_bars

if TYPE_CHECKING:
    from ..calibrate.mount import MeasuredPlace


def mount(
    images: PhotoPath,
    *,
    board: str,
    square_mm: float,
    poses: LogPath,
    rig: RigFile,
    fps: float | None = None,
    start_time: str = "0",
    time_offset_s: float = 0.0,
    measured_mm: str | None = None,
    measured_sigma_mm: float = 5.0,
) -> None:
    """Find where the camera sits on the vehicle, from photos of a board that stands still.

    Parameters
    ----------
    images
        A folder of photos of the board with a times.csv, or a video: 15 or more, the vehicle turned
        another way in each, about two axes at least.
    board
        Inner corners of the board, such as 9x6: where black squares touch, not squares.
    square_mm
        Side of a square [mm].
    poses
        Log of the vehicle's poses: CSV with time_s,x_m,y_m,z_m,qw,qx,qy,qz, or TUM.
    rig
        The rig file, with its camera. Its other tables and comments stay.
    fps
        Photos a second, for a folder without times.csv.
    start_time
        When the recording began, by the log's clock: seconds, or ISO 8601.
    time_offset_s
        Added to the photos' times [s].
    measured_mm
        Where the lens sits on the vehicle, as X,Y,Z measured with a ruler [mm]: for a vehicle that
        cannot turn about two axes.
    measured_sigma_mm
        Standard deviation of each of the three [mm].
    """
    from ..io.poses import load_poses
    from ..survey.calibrate_mount import PhotoClock, calibrate_mount_from_photos

    measured = None if measured_mm is None else _place(measured_mm, measured_sigma_mm)
    with progress_bars() as progress:
        result = calibrate_mount_from_photos(
            images,
            parse_board(board, square_mm),
            rig,
            load_poses(poses),
            clock=PhotoClock(fps, read_start_time(start_time), time_offset_s),
            measured=measured,
            progress=progress,
        )
    print_result(result, rig)


def _place(text: str, sigma_mm: float) -> "MeasuredPlace":
    """Make the measured place of --measured-mm."""
    place = read_numbers(text, 3)
    if place is None:
        raise InputError(
            f"--measured-mm {text!r} is not X,Y,Z; give three numbers of millimetres, such as "
            "120,0,-35."
        )
    import numpy as np

    from ..calibrate.mount import MeasuredPlace

    return MeasuredPlace(np.array(place) / 1e3, sigma_mm / 1e3)
