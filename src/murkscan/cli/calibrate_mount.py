"""murkscan calibrate mount: where the camera sits on the vehicle."""

import math
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import InputError
from .calibrate import parse_board
from .options import read_numbers, read_start_time
from .paths import LogPath, PhotoPath, RigFile
from .progress import progress_bars
from .words import print_table, say, say_verdict

if TYPE_CHECKING:
    from ..calibrate.hand_eye import MeasuredPlace
    from ..survey.calibrate_mount import MountResult


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
    _print_mount(result, rig)


def _place(text: str, sigma_mm: float) -> "MeasuredPlace":
    """Make the measured place of --measured-mm."""
    place = read_numbers(text, 3)
    if place is None:
        raise InputError(
            f"--measured-mm {text!r} is not X,Y,Z; give three numbers of millimetres, such as "
            "120,0,-35."
        )
    import numpy as np

    from ..calibrate.hand_eye import MeasuredPlace

    return MeasuredPlace(np.array(place) / 1e3, sigma_mm / 1e3)


def _print_mount(result: "MountResult", rig: Path) -> None:
    found = result.calibration
    shift, (w, x, y, z) = (
        found.vehicle_from_camera.translation,
        (found.vehicle_from_camera.as_quaternion()[0]),
    )
    rows: list[tuple[str, ...]] = [
        (f"{axis}", f"{1e3 * place:.2f}", f"{1e3 * sigma:.2g}", "mm")
        for axis, place, sigma in zip("xyz", shift, found.sigma[:3], strict=True)
    ]
    rows += [
        (f"turn about the camera's {axis}", "", f"{math.degrees(sigma):.2g}", "degrees")
        for axis, sigma in zip("xyz", found.sigma[3:], strict=True)
    ]
    if found.clock_offset is not None and found.clock_sigma is not None:
        clock = (f"{found.clock_offset:+.4f}", f"{found.clock_sigma:.2g}", "s")
        rows.append(("clock: add to the photos' times", *clock))
    print_table("Mount: the camera on the vehicle", ("parameter", "value", "± 1σ", "unit"), rows)
    say(f"quaternion w x y z: {w:.6f} {x:.6f} {y:.6f} {z:.6f}")
    print_table(
        "Photos",
        ("photo", "RMS [px]", "closes to [mm]", "and [degrees]"),
        [
            (view.name, f"{rms:.2f}", f"{1e3 * closure:.3f}", f"{math.degrees(turn):.3f}")
            for view, rms, closure, turn in zip(
                found.views, found.view_rms, found.closures, found.turns, strict=True
            )
        ],
    )
    say(
        f"The circles close to {1e3 * found.closure:.3f} mm and {math.degrees(found.turn):.3f} "
        f"degrees (RMS) with the board at {1e3 * found.distance:.0f} mm."
    )
    _say_clock(result)
    words = f"{len(found.views)} of {result.num_photos} photos used"
    if result.without_board:
        words += f"; {len(result.without_board)} without a whole board"
    say(words + ".")
    for reason in result.skipped.values():
        say(f"Skipped: {reason}")
    say_verdict(str(result.verdict), result.verdict.is_good)
    say(f"Written to {rig}; the photos with their corners lie in {result.pictures}.")


def _say_clock(result: "MountResult") -> None:
    found = result.calibration
    if found.clock_offset is None or found.clock_sigma is None:
        say("The clock's offset is not determined: the vehicle stood still in the photos.")
    elif abs(found.clock_offset) > 2 * found.clock_sigma:
        say(f"Scan with --time-offset-s {result.time_offset:.4f}.")
