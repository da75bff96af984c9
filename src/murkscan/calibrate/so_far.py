"""What the photos of a board tell so far of what they are taken for, and which are missing."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool

from ..errors import EstimationError
from ..types.arrays import Directions
from ..types.pose import Pose
from .board.chessboard import Chessboard
from .board.coverage import BoardCoverage, cover
from .board.view import BoardView
from .calibration import Calibration
from .precision import Precision, precisions_of
from .turns import turning_axes
from .verdict import RATIO, WIDTH, judge

_TILTED = np.sin(np.radians(15.0))
"""Sine of the tilt from which a board counts as tilted to a side; photos are asked for with 20 to
40 degrees."""
_FARTHER = {"camera": 1.3, "port": RATIO, "laser": (2 + WIDTH) / (2 - WIDTH)}
"""Farthest over nearest board below which others nearer or farther are asked for, where distances
count."""
_TURNED = np.radians(20.0) / np.sqrt(3)
"""Spread of a vehicle's attitudes about an axis from which it counts as turned about it [rad]: that
of turns spread evenly over the 20 degrees to each side that are asked for."""
_SIDES = (
    ("left", 0, -1.0),
    ("right", 0, 1.0),
    ("upper", 1, -1.0),
    ("lower", 1, 1.0),
)
"""The edge that is nearer to the camera, by the board's normal away from it: its x or y grows as
the right or the lower edge comes nearer."""


@dataclass(frozen=True, eq=False)
class SoFar:
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
    precisions: tuple[Precision, ...] = ()
    """How well what they are taken for is known; none where it is not determined."""
    rms: float | None = None
    """What corners are off by [px]."""


def judge_so_far(
    step: str,
    views: Sequence[BoardView],
    board: Chessboard,
    size: tuple[int, int],
    calibrate: Callable[[], Calibration],
    *,
    locate: Callable[[BoardView], Pose] | None = None,
) -> SoFar:
    """Judge the photos that are there, as the step itself would, and say what is missing.

    Args:
        step: The step of the calibration: camera, port, laser or mount.
        views: What was found in each photo.
        board: The board.
        size: Width and height of the photos [px].
        calibrate: Does the step on these photos.
        locate: Gives camera_from_board of a view by the camera as it is known, for what is missing
            until the step has an answer; None where no camera is known.
    """
    found = [view for view in views if view.is_found]
    coverage = cover_found(found, size)
    try:
        calibration = calibrate()
    except EstimationError as error:
        boards = [] if locate is None else [locate(view) for view in found]
        depths = [float((pose @ board.points().mean(axis=0)[None])[0, 2]) for pose in boards]
        missing = tuple(_list_missing(step, boards, depths, coverage))
        return SoFar(len(found), coverage, str(error), False, missing)
    verdict = judge(calibration)
    boards = [sighting.camera_from_board for sighting in calibration.sightings]
    missing = (
        *_list_missing(step, boards, calibration.depths, coverage),
        *_list_turns(calibration),
    )
    return SoFar(
        len(found), coverage, str(verdict), verdict.is_good, missing,
        precisions_of(calibration, verdict.errors), calibration.rms,
    )  # fmt: skip


def cover_found(found: Sequence[BoardView], size: tuple[int, int]) -> BoardCoverage | None:
    """Tell which parts of the picture corners were in; None where the board is in no photo."""
    return cover(np.concatenate([view.corners for view in found]), size) if found else None


def _list_missing(
    step: str, boards: Sequence[Pose], depths: Sequence[float], coverage: BoardCoverage | None
) -> Iterator[str]:
    """Name edges, distances and places in the picture that no photo shows."""
    is_lens = step in ("camera", "port")
    if boards and is_lens:
        yield from (
            f"with its {edge} edge nearer"
            for edge in untilted(np.stack([board.rotation[:, 2] for board in boards]))
        )
    if boards and step in _FARTHER:
        near, far = min(depths), max(depths)
        if far < _FARTHER[step] * near:
            yield f"nearer than {near * 1e3:.0f} mm and farther than {far * 1e3:.0f} mm"
    if is_lens and coverage is not None and not np.all(_corner_cells(coverage.cells)):
        yield coverage.emptiest_place


def _list_turns(calibration: Calibration) -> Iterator[str]:
    """Say how the vehicle has still to be turned, for a mount."""
    if calibration.logged is None:
        return
    spread, axes = turning_axes(calibration.logged.log.poses_at(calibration.logged.times))
    if spread[0] < _TURNED:
        yield "with the vehicle turned by 20 degrees about two different axes"
    elif spread[1] < _TURNED:
        x, y, z = axes[0]
        yield (
            "with the vehicle turned by 20 degrees about another axis than "
            f"({x:.2f}, {y:.2f}, {z:.2f})"
        )


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
