"""Calibrate lasers from photos of their lines on a board."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ..calibrate.adjust.parameters import window_prior
from ..calibrate.adjust.priors import join
from ..calibrate.board.chessboard import Chessboard, Margin
from ..calibrate.laser import calibrate_lasers
from ..calibrate.state import tables_before
from ..errors import InputError, MissingResult
from ..extract import AbstractExtractor, GrayGravity
from ..io.rig_toml import parse_rig, read_tables
from ..types.laser import Fan, Laser
from ..types.rig import Rig
from ..types.rig_covariance import RigCovariance
from .board_stripes import StripeFinder
from .calibrate import BoardSession, CalibrationResult
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


def calibrate_laser_from_photos(
    path: Path,
    board: Chessboard,
    rig_path: Path,
    *,
    margin: Margin | None = None,
    laser: int | Sequence[int] = 0,
    fan: FanKnowledge | None = None,
    index_sigma: float = 2e-4,
    extractor: AbstractExtractor | None = None,
    progress: Progress = silent,
) -> CalibrationResult:
    """Calibrate the sheet of a laser and write it to a rig file; the rest of the file stays.

    The camera and its port are adjusted along within their covariance, and written too. Done
    again, it starts from the camera as it was before.

    Args:
        path: A folder of photos of the laser's line on the board, taken in what [water] says, or
            in air where the rig has none; or a video.
        board: The board.
        rig_path: The rig file, with its camera.
        margin: How far the board's flat paper runs on beyond its squares; unless given, one square.
        laser: Number of the laser that is new or replaced, or several whose lines are on the same
            photos; lines of other lasers of the rig are told by their sheets and passed over.
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
    numbers = (laser,) if isinstance(laser, int) else tuple(laser)
    step = ["laser", ",".join(map(str, numbers))]
    tables = read_tables(rig_path) if rig_path.exists() else {}
    tables = tables_before(tables, step, name=str(rig_path))
    rig = _parse_calibrated(tables, rig_path, numbers)
    fans = {} if fan is None else {n: _fan_of(rig, n, rig_path) for n in numbers}
    folder = "laser_" + "_".join(map(str, numbers))
    session = BoardSession.open(path, board, rig_path, folder, tables=tables, progress=progress)
    views = session.find_boards(size=rig.camera.size)
    margin = margin or Margin(board.square, board.square, board.square, board.square)
    finder = StripeFinder(session.photos, views, board, margin, rig, extractor or GrayGravity())
    session.stripes = finder.find(numbers, progress)
    session.unused |= finder.reasons
    prior = None
    for number, measured in fans.items():
        assert fan is not None
        prior = join(prior or RigCovariance(), _prior(Laser.from_sheet(measured), number, fan))
    hints = "".join(f" {remark}" for remark in finder.remarks)
    found = session.solve(
        lambda: calibrate_lasers(
            session.stripes, views, board, rig, numbers=numbers, fans=fans, prior=prior,
            considered=_index(rig, index_sigma),
        ),
        hint=hints,
    )  # fmt: skip
    title = f"Laser {', '.join(map(str, numbers))}"
    result = session.finish(found, step, title=title)
    return replace(result, remarks=(*finder.remarks, *result.remarks))


def _parse_calibrated(tables: dict[str, Any], rig_path: Path, numbers: Sequence[int]) -> Rig:
    """Make a rig that has a camera, and room for the lasers."""
    if "camera" not in tables:
        raise MissingResult(
            f"{rig_path} has no camera yet; run `murkscan calibrate camera` first with the same "
            "--rig."
        )
    rig = parse_rig(tables, name=str(rig_path))
    room = len(rig.lasers)
    for number in numbers:
        if not 0 <= number <= room:
            raise InputError(
                f"{rig_path} has {len(rig.lasers)} laser(s), numbered from 0, so --laser may be "
                f"0 to {room}, not {number}."
            )
        room = max(room, number + 1)
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


def _prior(laser: Laser, number: int, fan: FanKnowledge) -> RigCovariance:
    return window_prior(
        laser,
        number,
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
