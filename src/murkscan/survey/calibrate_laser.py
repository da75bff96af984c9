"""Calibrate lasers from photos of their lines on a board."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ..calibrate.adjust.parameters import window_prior
from ..calibrate.adjust.priors import join
from ..calibrate.board.chessboard import Chessboard, Margin
from ..calibrate.calibration import Calibration
from ..calibrate.laser import calibrate_lasers
from ..calibrate.state import tables_before
from ..errors import InputError, MissingResult
from ..extract import AbstractExtractor, GrayGravity
from ..io.rig_toml import parse_rig, read_tables
from ..types.laser import Fan, Laser
from ..types.rig import Rig
from ..types.rig_covariance import RigCovariance
from .board_stripes import StripeFinder
from .calibrate import BoardSession, CalibrationResult, Fit, size_in
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
    plan = LaserPlan(numbers, margin, fan, index_sigma, extractor or GrayGravity())
    tables, fit = plan.read(rig_path)
    folder = "laser_" + "_".join(map(str, numbers))
    session = BoardSession.open(path, board, rig_path, folder, tables=tables, progress=progress)
    session.find_boards(size=size_in(tables))
    found = session.solve(fit)
    return session.finish(found, plan.step, title=f"Laser {', '.join(map(str, numbers))}")


@dataclass(frozen=True)
class LaserPlan:
    """Which lasers are calibrated, and by what; as `calibrate_laser_from_photos` takes it."""

    numbers: tuple[int, ...] = (0,)
    margin: Margin | None = None
    fan: FanKnowledge | None = None
    index_sigma: float = 2e-4
    extractor: AbstractExtractor = field(default_factory=GrayGravity)

    @property
    def step(self) -> list[str]:
        """Where in [calibration] the record goes."""
        return ["laser", ",".join(map(str, self.numbers))]

    def read(self, rig_path: Path) -> tuple[dict[str, Any], Fit]:
        """Read the rig file as it was before this step, and say how the lasers are fitted.

        Raises:
            MissingResult: The camera has not been calibrated, or the laser is no fan there.
            InputError: The number of a laser leaves a gap.
            FormatError: The rig file is none.
        """
        tables = read_tables(rig_path) if rig_path.exists() else {}
        tables = tables_before(tables, self.step, name=str(rig_path))
        rig = _parse_calibrated(tables, rig_path, self.numbers)
        fans = {} if self.fan is None else {n: _fan_of(rig, n, rig_path) for n in self.numbers}
        return tables, lambda session: self._fit(session, rig, fans)

    def _fit(self, session: BoardSession, rig: Rig, fans: Mapping[int, Fan]) -> Calibration:
        square = session.board.square
        finder = StripeFinder(
            session.photos, session.views, session.board,
            self.margin or Margin(square, square, square, square), rig, self.extractor,
        )  # fmt: skip
        session.stripes = finder.find(self.numbers, session.progress)
        session.unused |= finder.reasons
        session.remarks += finder.remarks
        prior = None
        for number, measured in fans.items():
            own = _prior(Laser.from_sheet(measured), number, self.fan or FanKnowledge())
            prior = join(prior or RigCovariance(), own)
        return calibrate_lasers(
            session.stripes, session.views, session.board, rig, numbers=self.numbers, fans=fans,
            prior=prior, considered=_index(rig, self.index_sigma),
        )  # fmt: skip


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
