"""murkscan calibrate laser: find a laser's sheet, in air or under water."""

import math
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from ..errors import InputError
from .calibrate import parse_board
from .calibrate_port import print_parameters, say_photos
from .choices import ExtractorName, make_extractor
from .options import read_numbers
from .paths import PhotoPath, RigFile
from .progress import progress_bars
from .words import print_table, say, say_verdict

if TYPE_CHECKING:
    from ..calibrate import LaserCalibration, Margin
    from ..survey.calibrate_laser import LaserResult


def laser(
    images: PhotoPath,
    *,
    board: str,
    square_mm: float,
    rig: RigFile,
    kind: Literal["plane", "fan"] = "plane",
    margin_mm: str | None = None,
    laser: int = 0,
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
        Number of the laser that is new or replaced, from 0.
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
    margin = None if margin_mm is None else parse_margin(margin_mm)
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
            laser=laser,
            fan=fan if kind == "fan" else None,
            index_sigma=index_sigma,
            extractor=make_extractor(extractor, ()),
            progress=progress,
        )
    _print_laser(result, rig)


def parse_margin(text: str) -> "Margin":
    """Make the margin of --margin-mm."""
    sides = read_numbers(text, 4)
    if sides is None:
        raise InputError(
            f"--margin-mm {text!r} is not LEFT,RIGHT,TOP,BOTTOM; give four numbers of millimetres, "
            "such as 120,80,60,60."
        )
    from ..calibrate import Margin

    return Margin(*(side / 1e3 for side in sides))


def _print_laser(result: "LaserResult", rig: Path) -> None:
    from ..calibrate.limits import most_influential
    from ..types.laser import Laser

    found = result.calibration
    fit = found.fit
    print_parameters(found.adjustment, f"Laser {found.number}")
    n, d = fit.sheet.normal, fit.sheet.distance
    baseline, angle = Laser(fit.sheet, found.laser.axis).as_baseline_angle()
    print_table(
        "Sheet",
        ("what", "value"),
        [
            (
                "equivalent plane",
                f"{n[0]:+.6f} X {n[1]:+.6f} Y {n[2]:+.6f} Z {d * 1e3:+.3f} mm = 0",
            ),
            ("direction, ± 1σ", f"{math.degrees(fit.angle_sigma):.3f} degrees"),
            ("axis", found.laser.axis),
            ("equivalent b", f"{baseline * 1e3:.2f} mm"),
            ("equivalent θ", f"{math.degrees(angle):.3f} degrees"),
            *_point_rows(found),
        ],
    )
    print_table(
        "Photos",
        ("photo", "points", "RMS [mm]"),
        [
            (s.name, str(len(s.pixels)), f"{rms * 1e3:.3f}")
            for s, rms in zip(fit.stripes, fit.view_rms, strict=True)
        ],
    )
    say(
        f"RMS {fit.rms * 1e3:.3f} mm over {fit.num_inliers} of {fit.num_points} stripe points; "
        f"{fit.num_points - fit.num_inliers} lay off the sheet and count less or not at all."
    )
    say(most_influential(found.adjustment, [s.name for s in found.sightings]))
    say_photos(result, used=len(fit.stripes))
    if result.without_stripe:
        say(
            f"{len(result.without_stripe)} photos show a board but no stripe on its paper; "
            "--margin-mm says how far the paper runs on."
        )
    say_verdict(str(result.verdict), result.verdict.is_good)
    say(f"Written to {rig}; see {result.page}, with every photo and its stripes beside it.")


def _point_rows(found: "LaserCalibration") -> list[tuple[str, str]]:
    """Tell how well a point is known near, in the middle and far, by the calibration alone."""
    from ..calibrate.reach import point_sigma, reach_of

    depths = reach_of(found.adjustment.camera_from_boards, found.sightings)
    rows = []
    for depth in depths:
        sigma = point_sigma(found.rig, found.number, depth)
        if math.isfinite(sigma):
            rows.append((f"a point {depth * 1e3:.0f} mm away, ± 1σ", f"{sigma * 1e3:.3f} mm"))
    return rows
