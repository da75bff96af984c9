"""murkscan calibrate laser: find a laser's sheet, in air or under water."""

import math
from typing import Literal

from ..errors import InputError
from ..ui.calibration_values import read_lasers, read_margin
from ..ui.choices import ExtractorName, make_extractor
from .calibrate import parse_board
from .calibrate_result import print_result
from .paths import PhotoPath, RigFile
from .progress import progress_bars


def laser(
    images: PhotoPath,
    *,
    board: str,
    square_mm: float,
    rig: RigFile,
    kind: Literal["plane", "fan"] = "plane",
    margin_mm: str | None = None,
    laser: str = "0",
    origin_sigma_mm: float = 2.0,
    port_tilt_sigma_deg: float = 1.0,
    port_distance_sigma_mm: float = 1.0,
    index_sigma: float = 2e-4,
    extractor: ExtractorName = "gray-gravity",
) -> None:
    """Calibrate a laser on photos of its line on a chessboard, and write it to the rig file.

    Parameters
    ----------
    images
        A folder of photos of the line on the board, or a video: near, far, and between; in air,
        or in the water of [water].
    board
        Inner corners of the board, such as 8x6: where black squares touch, not squares.
    square_mm
        Side of a square [mm].
    rig
        The rig file, with its camera, and its port where it has one. Other tables and comments
        stay.
    kind
        plane: a flat sheet. fan: rays from a point, as the rig file has them roughly, bent by
        [laser.port] where there is one.
    margin_mm
        How far the flat paper runs on beyond the squares, as LEFT,RIGHT,TOP,BOTTOM [mm]; one
        square on each side unless given.
    laser
        Number of the laser that is new or replaced, from 0; or several, such as 0,1, whose lines
        are on the same photos. Lines of the rig's other lasers are passed over.
    origin_sigma_mm
        How well it is known beforehand where a fan behind a port starts [mm, 1σ].
    port_tilt_sigma_deg
        How well the direction of a fan's port is known beforehand [degrees, 1σ].
    port_distance_sigma_mm
        How well its distance from the fan's origin is known beforehand [mm, 1σ].
    index_sigma
        Standard deviation of the water's index as [water] gives it.
    extractor
        The way to find the stripe.
    """
    chessboard = parse_board(board, square_mm)
    margin = None if margin_mm is None else read_margin(margin_mm)
    for flag, value in [
        ("--origin-sigma-mm", origin_sigma_mm),
        ("--port-tilt-sigma-deg", port_tilt_sigma_deg),
        ("--port-distance-sigma-mm", port_distance_sigma_mm),
        ("--index-sigma", index_sigma),
    ]:
        if not 0 < value < math.inf:
            raise InputError(f"{flag} must be a deviation above 0, got {value:g}.")
    from ..survey.calibrate_laser import FanKnowledge, calibrate_laser_from_photos

    fan = FanKnowledge(
        origin_sigma=origin_sigma_mm / 1e3,
        port_tilt_sigma=math.radians(port_tilt_sigma_deg),
        port_distance_sigma=port_distance_sigma_mm / 1e3,
    )
    with progress_bars() as progress:
        result = calibrate_laser_from_photos(
            images,
            chessboard,
            rig,
            margin=margin,
            laser=read_lasers(laser),
            fan=fan if kind == "fan" else None,
            index_sigma=index_sigma,
            extractor=make_extractor(extractor, ()),
            progress=progress,
        )
    print_result(result, rig)
