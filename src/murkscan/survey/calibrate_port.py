"""Calibrate a camera's port from photos of a board under water."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ..calibrate.adjust.parameters import INTRINSICS
from ..calibrate.board.chessboard import Chessboard
from ..calibrate.calibration import Calibration
from ..calibrate.port import calibrate_port
from ..calibrate.state import tables_before
from ..errors import InputError, MissingResult
from ..io.rig_toml import parse_rig, read_tables
from ..types.port import FlatPort
from ..types.rig import Rig
from ..types.rig_covariance import RigCovariance
from .calibrate import BoardSession, CalibrationResult, Fit, size_in
from .progress import Progress, silent

_LEAST, _MOST = 5e-4, 0.5
"""Distances of a port from the lens that can be [m]."""


@dataclass(frozen=True)
class Measured:
    """A value measured otherwise, and its standard deviation."""

    value: float
    sigma: float


@dataclass(frozen=True)
class PortKnowledge:
    """What is known of a port and its water before the photos are looked at."""

    distance: Measured | None = None
    """From the optical centre to a flat port [m]; None: as in the rig file, and to be found."""
    index_sigma: float = 2e-4
    """Standard deviation of the water's index as its temperature and salt give it: half a degree
    and a PSU. The index stays, but its error goes into the covariance."""
    is_index_free: bool = False
    """Whether to find the index too, from the board's known size."""
    is_camera_free: bool = False
    """Whether to find the camera too, though it was not calibrated in air."""


def calibrate_port_from_photos(
    path: Path,
    board: Chessboard,
    rig_path: Path,
    *,
    knowledge: PortKnowledge | None = None,
    progress: Progress = silent,
) -> CalibrationResult:
    """Calibrate a camera's port and write it to the rig file; the rest of the file stays.

    The camera is adjusted along within its covariance, and written too. Done again, it starts from
    the camera as it was before.

    Args:
        path: A folder of photos of the board, taken through the port in the water of [water], or a
            video.
        board: The board.
        rig_path: The rig file, with its camera, its port as it was measured, and its water.
        knowledge: What is known beforehand.
        progress: Told of each photo.

    Raises:
        MissingResult: The rig has no camera, or no port.
        InputError: The port's distance cannot be, there are no photos, they are not of the rig's
            size, or they lie where the drawings go.
        FormatError: None of the photos can be read, or the rig file is none.
        NotEnoughData: The board was found in fewer than four photos.
        Degenerate: The photos do not determine every parameter.
    """
    knowledge = knowledge or PortKnowledge()
    tables, fit = plan_port(rig_path, knowledge)
    session = BoardSession.open(path, board, rig_path, "port", tables=tables, progress=progress)
    session.find_boards(size=size_in(tables))
    found = session.solve(fit)
    return session.finish(
        found, ["port"], title="Camera port", keep_water=not knowledge.is_index_free
    )


def plan_port(rig_path: Path, knowledge: PortKnowledge) -> tuple[dict[str, Any], Fit]:
    """Read the rig file as it was before this step, and say how the port is fitted.

    Raises:
        MissingResult: The rig has no camera, or no port.
        InputError: The port's distance cannot be.
        FormatError: The rig file is none.
    """
    tables = tables_before(read_tables(rig_path), ["port"], name=str(rig_path))
    rig = _with_port(parse_rig(tables, name=str(rig_path)), rig_path, knowledge)
    return tables, lambda session: _fit(session, rig, knowledge)


def _fit(session: BoardSession, rig: Rig, knowledge: PortKnowledge) -> Calibration:
    distance = knowledge.distance
    free = (
        *(INTRINSICS if knowledge.is_camera_free else ()),
        *(("water.index",) if knowledge.is_index_free else ()),
    )
    index = RigCovariance(("water.index",), np.array([[knowledge.index_sigma**2]]))
    prior = None
    if distance is not None:
        prior = RigCovariance(("camera.port.distance",), np.array([[distance.sigma**2]]))
    return calibrate_port(
        session.views, session.board, rig, free=free, prior=prior,
        considered=None if knowledge.is_index_free else index,
    )  # fmt: skip


def _with_port(rig: Rig, rig_path: Path, knowledge: PortKnowledge) -> Rig:
    """Give the rig with its port where it was measured to be; refuse one that cannot be."""
    port = rig.camera.port
    if port is None or rig.water is None:
        missing = "[camera.port]" if port is None else "[water]"
        raise MissingResult(
            f"{rig_path} has no {missing} yet; write it as you measured it, the port with kind, "
            "normal, distance_mm, thickness_mm and glass_index, the water with temperature_c and "
            "salinity_psu, and the photos will tell the rest."
        )
    if knowledge.is_camera_free:
        rig = replace(rig, covariance=rig.covariance.select([]))
    if not isinstance(port, FlatPort):
        if knowledge.distance is not None:
            raise InputError("A dome has a centre, not a distance; leave --distance-mm out.")
        return rig
    if knowledge.distance is not None:
        port = replace(port, distance=knowledge.distance.value)
    if not _LEAST < port.distance < _MOST:
        raise InputError(
            f"The port's distance of {port.distance * 1e3:g} mm cannot be: it lies between "
            f"{_LEAST * 1e3:g} and {_MOST * 1e3:g} mm. Give it in millimetres, as "
            "camera.port.distance_mm or --distance-mm."
        )
    return replace(rig, camera=replace(rig.camera, port=port))
