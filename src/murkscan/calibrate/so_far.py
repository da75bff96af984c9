"""What the photos of a board tell of a camera so far, and which are still missing."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool

from ..errors import EstimationError
from ..types.arrays import Directions
from .board.chessboard import Chessboard
from .board.coverage import BoardCoverage, cover
from .board.view import BoardView
from .calibration import Calibration
from .camera import calibrate_camera
from .verdict import judge

_TILTED = np.sin(np.radians(15.0))
"""Sine of the tilt from which a board counts as tilted to a side; photos are asked for with 20 to
40 degrees."""
_NEARER = 1.3
"""Farthest over nearest board below which others nearer or farther are asked for."""
_SIDES = (
    ("left", 0, -1.0),
    ("right", 0, 1.0),
    ("upper", 1, -1.0),
    ("lower", 1, 1.0),
)
"""The edge that is nearer to the camera, by the board's normal away from it: its x or y grows as
the right or the lower edge comes nearer."""


@dataclass(frozen=True, eq=False)
class CameraSoFar:
    """What the photos tell."""

    num_found: int
    """Photos that show the board."""
    coverage: BoardCoverage | None
    """Which parts of the picture its corners were in; None where it was found in none."""
    verdict: str
    """What they are worth, in plain words."""
    is_good: bool
    missing: tuple[str, ...]
    """Photos that would help, in words that follow "show it"."""
    focal_sigma: float | None
    """Standard deviation of the focal length, over itself; None where it is not determined."""
    rms: float | None
    """What corners are off by [px]."""


def judge_so_far(
    views: Sequence[BoardView], board: Chessboard, size: tuple[int, int]
) -> CameraSoFar:
    """Judge the photos that are there, as `calibrate_camera` would, and say what is missing.

    Args:
        views: What was found in each photo.
        board: The board.
        size: Width and height of the photos [px].
    """
    found = [view for view in views if view.is_found]
    coverage = cover(np.concatenate([v.corners for v in found]), size) if found else None
    missing: tuple[str, ...] = () if coverage is None else (coverage.emptiest_place,)
    try:
        camera = calibrate_camera(views, board, size)
    except EstimationError as error:
        return CameraSoFar(len(found), coverage, str(error), False, missing, None, None)
    verdict = judge(camera)
    missing = tuple(_list_missing(camera, coverage))
    focal_sigma = float(camera.sigma[0] / camera.rig.camera.focal_length[0])
    return CameraSoFar(
        len(found), coverage, str(verdict), verdict.is_good, missing, focal_sigma, camera.rms
    )


def _list_missing(camera: Calibration, coverage: BoardCoverage | None) -> Iterator[str]:
    away = np.stack([s.camera_from_board.rotation[:, 2] for s in camera.sightings])
    for edge in untilted(away):
        yield f"with its {edge} edge nearer"
    depths = camera.depths
    if max(depths) < _NEARER * min(depths):
        yield "nearer and farther"
    if coverage is not None and not np.all(_corner_cells(coverage.cells)):
        yield coverage.emptiest_place


def untilted(away: Directions) -> list[str]:
    """Name the edges that no board had nearer to the camera.

    Args:
        away: The boards' normals, away from the camera, in its frame.
    """
    return [edge for edge, axis, sign in _SIDES if not np.any(sign * away[:, axis] > _TILTED)]


def _corner_cells(cells: Bool[np.ndarray, "10 10"]) -> Bool[np.ndarray, "4"]:
    """Tell in which corners of the picture, a fifth of it wide, a corner of the board was."""
    return np.array([part.any() for part in (cells[:2, :2], cells[:2, -2:], cells[-2:, :2],
                                             cells[-2:, -2:])])  # fmt: skip
