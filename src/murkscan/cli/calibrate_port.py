"""murkscan calibrate port: find how the camera's port stands, in the water at hand."""

import math
import re
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from ..errors import InputError
from .calibrate import parse_board
from .paths import PhotoPath, RigFile
from .progress import progress_bars
from .words import print_table, say, say_verdict

if TYPE_CHECKING:
    from ..calibrate.adjust import Adjustment
    from ..survey.calibrate_laser import LaserResult
    from ..survey.calibrate_port import Measured, PortResult

_NUMBER = r"[0-9]*\.?[0-9]+"


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
        distance=None if distance_mm is None else parse_measured(distance_mm),
        index_sigma=_check_sigma(index_sigma),
        is_index_free=index == "free",
        is_camera_free=camera == "free",
    )
    with progress_bars() as progress:
        result = calibrate_port_from_photos(
            images, chessboard, rig, knowledge=knowledge, progress=progress
        )
    _print_port(result, rig)


def parse_measured(text: str) -> "Measured":
    """Make metres of a text such as 30±2 in millimetres."""
    match = re.fullmatch(rf"\s*({_NUMBER})\s*(?:±|\+/?-)\s*({_NUMBER})\s*", text)
    if match is None or not float(match[2]) > 0:
        raise InputError(
            f"--distance-mm {text!r} is not a value with its standard deviation; write it as 30±2 "
            "or 30+-2, in millimetres."
        )
    from ..survey.calibrate_port import Measured

    return Measured(float(match[1]) / 1e3, float(match[2]) / 1e3)


def print_parameters(found: "Adjustment", title: str) -> None:
    """Print each parameter's deviation, and how much the photos say of it."""
    from ..calibrate.limits import as_read, strongest_pairs, value_of

    sigma = found.rig.covariance.select(found.names).sigma
    print_table(
        title,
        ("parameter", "value", "± 1σ", "from these photos"),
        [
            (name, value_of(found.rig, name), as_read(name, float(s)), f"{max(share, 0):.0%}")
            for name, s, share in zip(found.names, sigma, found.worth.from_photos, strict=True)
        ],
    )
    for pair in strongest_pairs(found.rig.covariance):
        say(f"{pair.first} and {pair.second} go together: correlation {pair.correlation:+.3f}.")


def say_photos(result: "PortResult | LaserResult", *, used: int) -> None:
    """Say which photos were used, and which were not and why."""
    words = f"{used} of {result.num_photos} photos used"
    if result.without_board:
        words += f"; without a whole board: {', '.join(result.without_board)}"
    say(words + ".")
    for reason in result.skipped.values():
        say(f"Skipped: {reason}")


def _print_port(result: "PortResult", rig: Path) -> None:
    from ..calibrate.limits import most_influential
    from ..calibrate.reach import reach_of, shape_sigma

    found = result.calibration.adjustment
    print_parameters(found, "Port")
    names = [sighting.name for sighting in result.calibration.sightings]
    print_table(
        "Views",
        ("photo", "RMS [px]"),
        [(n, f"{rms:.3f}") for n, rms in zip(names, result.calibration.view_rms, strict=True)],
    )
    depths = reach_of(found.camera_from_boards, result.calibration.sightings)
    print_table(
        "Shapes",
        ("distance", "± 1σ"),
        [(f"{z * 1e3:.0f} mm", f"{shape_sigma(found.rig, z) * 1e3:.3f} mm") for z in depths],
    )
    say(most_influential(found, names))
    say_photos(result, used=len(names))
    say_verdict(str(result.verdict), result.verdict.is_good)
    if result.lasers_to_redo:
        numbers = ", ".join(map(str, result.lasers_to_redo))
        say(f"Laser {numbers} was calibrated with the camera as it was; calibrate it again.")
    say(f"Written to {rig}; see {result.page}, with every photo and its corners beside it.")


def _check_sigma(sigma: float) -> float:
    if not 0 <= sigma < 1 or not math.isfinite(sigma):
        raise InputError(f"--index-sigma must be a deviation of 0 or more, got {sigma:g}.")
    return sigma
