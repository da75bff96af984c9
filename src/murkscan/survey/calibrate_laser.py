"""Calibrate a laser from photos of its line on a board: find, fit, judge, save, draw."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ..calibrate.board import Chessboard, Margin
from ..calibrate.laser import LaserCalibration, calibrate_laser
from ..calibrate.laser_verdict import judge_laser
from ..calibrate.parameters import window_prior
from ..calibrate.story import Story
from ..calibrate.verdict import CalibrationVerdict
from ..errors import EstimationError, InputError, MissingResult
from ..extract import AbstractExtractor, GrayGravity
from ..io.rig_toml import parse_rig, read_tables, save_calibration
from ..types.laser import Fan, Laser
from ..types.rig import Rig
from ..types.rig_covariance import RigCovariance
from .board_stripes import StripeFinder
from .board_views import find_boards
from .calibrate import open_photos
from .calibrate_drawing import draw_stripes, write_page
from .calibration_record import record_adjustment, record_laser, record_setting
from .calibration_state import snapshot, tables_before
from .progress import Progress, silent


@dataclass(frozen=True)
class FanKnowledge:
    """What is known of a fan before the photos are looked at; the rest stands in the rig file."""

    origin_sigma: float = 2e-3
    """Standard deviation of where the fan starts, within its plane [m]; of effect with a port."""
    port_tilt_sigma: float = float(np.radians(1.0))
    """Standard deviation of the direction of the fan's port [rad]."""
    port_distance_sigma: float = 1e-3
    """Standard deviation of its distance from the fan's origin [m]."""


@dataclass(frozen=True, eq=False)
class LaserResult:
    """What calibrating a laser gave."""

    calibration: LaserCalibration
    """The laser and what it is worth."""
    verdict: CalibrationVerdict
    """The same in plain words."""
    num_photos: int
    """Photos that could be read."""
    without_board: tuple[str, ...]
    """Photos in which the board was not found."""
    without_stripe: tuple[str, ...]
    """Photos with a board but no stripe on its paper."""
    skipped: Mapping[str, str]
    """Photos that could not be read, and why."""
    pictures: Path
    """Folder of the photos with their stripes drawn."""
    page: Path
    """The page that shows all of it."""


def calibrate_laser_from_photos(
    path: Path,
    board: Chessboard,
    rig_path: Path,
    *,
    margin: Margin | None = None,
    laser: int = 0,
    fan: FanKnowledge | None = None,
    index_sigma: float = 2e-4,
    extractor: AbstractExtractor | None = None,
    progress: Progress = silent,
) -> LaserResult:
    """Calibrate the sheet of a laser and write it to a rig file; the rest of the file stays.

    The camera and its port are adjusted along within their covariance, and written too. Done
    again, it starts from the camera as it was before.

    Args:
        path: A folder of photos of the laser's line on the board, taken in what [water] says, or
            in air where the rig has none; or a video.
        board: The board.
        rig_path: The rig file, with its camera.
        margin: How far the board's flat paper runs on beyond its squares; unless given, one square.
        laser: Number of the laser that is new or replaced.
        fan: For a laser that stands in the rig file as a fan; None for a flat sheet.
        index_sigma: Standard deviation of the water's index, where the rig says nothing of it.
        extractor: The way to find the stripe; gray gravity unless given.
        progress: Told of each photo.

    Raises:
        MissingResult: The camera has not been calibrated, or the laser is no fan in the rig file.
        InputError: The number of the laser leaves a gap, there are no photos, they are not of the
            rig's size, or they lie where the drawings go.
        FormatError: None of the photos can be read, or the rig file is none.
        NotEnoughData: Fewer than two photos show the board and the stripe.
        Degenerate: The boards stood nearly in one place, or a parameter is not determined.
    """
    step = ["laser", str(laser)]
    tables = read_tables(rig_path) if rig_path.exists() else {}
    tables = tables_before(tables, step, name=str(rig_path))
    rig = _parse_calibrated(tables, rig_path, laser)
    measured = None if fan is None else _fan_of(rig, laser, rig_path)
    photos, folder = open_photos(path, rig_path, f"laser_{laser}")
    views, _ = find_boards(photos, board, progress, size=rig.camera.size)
    margin = margin or Margin(board.square, board.square, board.square, board.square)
    finder = StripeFinder(photos, views, board, margin, rig, extractor or GrayGravity())
    stripes = finder.find(progress)
    draw = partial(
        draw_stripes, photos, stripes, folder, board=board, margin=margin, progress=progress
    )
    try:
        calibration = calibrate_laser(
            stripes, views, board, rig, number=laser, fan=measured,
            prior=None if fan is None else _prior(rig, laser, fan),
            considered=_index(rig, index_sigma),
        )  # fmt: skip
    except EstimationError as error:
        draw(rig=rig, fit=None)
        raise type(error)(f"{error} The photos with their stripes lie in {folder}.") from error
    verdict = judge_laser(calibration)
    record = (
        record_setting(board, len(views), tables)
        | record_adjustment(calibration.adjustment, (), verdict)
        | record_laser(calibration.fit)
    )
    _save(rig_path, calibration, record | {"before": snapshot(tables, laser=laser)}, step)
    draw(rig=calibration.rig, fit=calibration.fit)
    without = tuple(view.name for view in views if not view.is_found)
    adjusted = calibration.adjustment
    story = Story(f"Laser {laser}", adjusted, calibration.sightings, verdict, without, laser)
    return LaserResult(
        calibration=calibration,
        verdict=verdict,
        num_photos=len(views),
        without_board=without,
        without_stripe=tuple(stripe.name for stripe in stripes if len(stripe.pixels) == 0),
        skipped=photos.skipped,
        pictures=folder,
        page=write_page(folder, story),
    )


def _save(
    rig_path: Path, calibration: LaserCalibration, record: dict[str, Any], step: list[str]
) -> None:
    """Write the laser, and those others that moved along because their errors go together."""
    rig = calibration.rig
    moved = {
        number: laser
        for number, laser in enumerate(rig.lasers)
        if any(name.startswith(f"laser[{number}]") for name in rig.covariance.names)
    }
    save_calibration(rig_path, rig, step, record=record, lasers=moved)


def _parse_calibrated(tables: dict[str, Any], rig_path: Path, laser: int) -> Rig:
    """Make a rig that has a camera, and room for the laser."""
    if "camera" not in tables:
        raise MissingResult(
            f"{rig_path} has no camera yet; run `murkscan calibrate camera` first with the same "
            "--rig."
        )
    rig = parse_rig(tables, name=str(rig_path))
    if not 0 <= laser <= len(rig.lasers):
        raise InputError(
            f"{rig_path} has {len(rig.lasers)} laser(s), numbered from 0, so --laser may be "
            f"0 to {len(rig.lasers)}, not {laser}."
        )
    return rig


def _fan_of(rig: Rig, laser: int, rig_path: Path) -> Fan:
    sheet = rig.lasers[laser].sheet if laser < len(rig.lasers) else None
    if not isinstance(sheet, Fan):
        raise MissingResult(
            f"Laser {laser} is no fan in {rig_path} yet; write its [[laser]] as you measured it, "
            'with kind = "fan", origin_mm, direction, tangent and half_angle_deg, and '
            "[laser.port] where its light leaves a housing; the photos will tell the rest."
        )
    return sheet


def _prior(rig: Rig, laser: int, fan: FanKnowledge) -> RigCovariance:
    return window_prior(
        rig.lasers[laser],
        laser,
        origin_sigma=fan.origin_sigma,
        tilt_sigma=fan.port_tilt_sigma,
        distance_sigma=fan.port_distance_sigma,
    )


def _index(rig: Rig, sigma: float) -> RigCovariance | None:
    """Give how well the water's index is known, where light crosses a window into it."""
    has_port = rig.camera.port is not None or any(_has_port(laser) for laser in rig.lasers)
    if rig.water is None or not has_port or "water.index" in rig.covariance.names:
        return None
    return RigCovariance(("water.index",), np.array([[sigma**2]]))


def _has_port(laser: Laser) -> bool:
    return isinstance(laser.sheet, Fan) and laser.sheet.port is not None
