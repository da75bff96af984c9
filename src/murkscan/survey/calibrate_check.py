"""Check a rig on a known length: a board with the line on it, or two points of a scan."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..calibrate.board.chessboard import Chessboard, Margin
from ..calibrate.board.view import BoardView
from ..calibrate.check import BoardCheck, LinedBoard, check_on_boards, judge_boards, judge_length
from ..calibrate.verdict import CalibrationVerdict
from ..capture.photos import BoardPhotos
from ..errors import InputError
from ..extract import AbstractExtractor, GrayGravity
from ..io.rig_toml import load_rig
from ..optics.length import Length, measure_length
from ..optics.seen_points import shifts_in_world
from ..project import Project, load_moving_rig
from ..types.arrays import Points, Vector
from ..types.profile import Profile
from ..types.rig import Rig
from ..types.trajectory import Trajectory
from .board_stripes import StripeFinder
from .board_views import find_boards
from .progress import Progress, silent

_FARTHEST = 0.01
"""Distance from a given place within which a point of the scan must lie [m]."""


@dataclass(frozen=True, eq=False)
class BoardCheckResult:
    """What checking on photos gave."""

    check: BoardCheck
    """The size of the squares as measured."""
    verdict: CalibrationVerdict
    """The same in plain words."""
    num_photos: int
    """Photos that could be read."""
    unused: Mapping[str, str]
    """Photos that were not used, and why."""


@dataclass(frozen=True, eq=False)
class ScanCheckResult:
    """What checking between two points of a scan gave."""

    length: Length
    """Their distance."""
    verdict: CalibrationVerdict
    """The same beside the known length, in plain words."""
    ends: Points
    """The two points of the scan [m], in the world."""
    is_common_known: bool
    """Whether the rig states a covariance."""


def check_on_photos(
    path: Path,
    board: Chessboard,
    rig_path: Path,
    *,
    margin: Margin | None = None,
    laser: int = 0,
    extractor: AbstractExtractor | None = None,
    progress: Progress = silent,
) -> BoardCheckResult:
    """Measure the squares of a board with the laser's line on it; nothing is written.

    Args:
        path: A folder of photos, or a video, in the water that the rig file states.
        board: The board, with the known size of its squares.
        rig_path: The rig file.
        margin: How far the board's flat paper runs on beyond its squares; unless given, one square.
        laser: Number of the laser.
        extractor: The way to find the stripe; gray gravity unless given.
        progress: Told of each photo.

    Raises:
        InputError: There is no such laser, the photos are not of the rig's size, or the size comes
            out wrong by more than 30 %.
        FormatError: None of the photos can be read, or the rig file is none.
        NotEnoughData: Fewer than three photos show the board and the line.
    """
    rig = load_rig(rig_path)
    rig.laser(laser)
    photos = BoardPhotos.open(path)
    views, _ = find_boards(photos, board, progress, size=rig.camera.size)
    check, reasons = check_views(
        photos, views, board, rig, margin=margin, laser=laser, extractor=extractor,
        progress=progress,
    )  # fmt: skip
    unused = photos.skipped | reasons
    unused |= {view.name: view.reason for view in views if not view.is_found}
    return BoardCheckResult(check, judge_boards(check, rig), len(views), unused)


def check_views(
    photos: BoardPhotos,
    views: Sequence[BoardView],
    board: Chessboard,
    rig: Rig,
    *,
    margin: Margin | None = None,
    laser: int = 0,
    extractor: AbstractExtractor | None = None,
    progress: Progress = silent,
) -> tuple[BoardCheck, dict[str, str]]:
    """Measure the squares of boards that were found already.

    Returns:
        The squares, and the photos with a board that are not used, and why.

    Raises:
        InputError: The size comes out wrong by more than 30 %.
        NotEnoughData: Fewer than three photos show the board and the line.
    """
    margin = margin or Margin(board.square, board.square, board.square, board.square)
    finder = StripeFinder(photos, views, board, margin, rig, extractor or GrayGravity())
    by_name = {view.name: view for view in views}
    lined = [
        LinedBoard(by_name[stripe.name], stripe.pixels) for stripe in finder.find([laser], progress)
    ]
    return check_on_boards(lined, board, rig, laser), finder.reasons


def check_in_scan(
    project: Project, ends: Points, known: float, *, known_sigma: float = 0.0
) -> ScanCheckResult:
    """Measure the length between two points of a scan beside the known one.

    Args:
        project: A scan with finished triangulate and motion stages.
        ends: Where the two ends are, read off the cloud [m]; the nearest points count.
        known: The length between them as known [m].
        known_sigma: Its standard deviation [m].

    Raises:
        MissingResult: An earlier stage has not been finished.
        InputError: The known length is not above 0, or no point of the scan lies within 10 mm of
            an end.
        Degenerate: Both ends are the same point.
    """
    if not (known > 0 and known_sigma >= 0):
        raise InputError(
            "A known length must be above 0 and its deviation not below, got "
            f"{known * 1e3:g} ± {known_sigma * 1e3:g} mm."
        )
    rig = load_moving_rig(project)
    profile = Profile.concatenate(list(project.load_placed_parts()))
    trajectory = project.load_trajectory()
    in_world = trajectory.transform(profile.points, profile.time)
    nearest = np.array([_nearest(in_world, end) for end in ends])
    length = _measure(profile[nearest], in_world[nearest], trajectory, rig)
    is_common_known = bool(rig.covariance.names) or trajectory.errors is not None
    verdict = judge_length(
        length.value,
        known,
        float(np.hypot(length.sigma, known_sigma)),
        is_common_known=is_common_known,
    )
    return ScanCheckResult(length, verdict, in_world[nearest], is_common_known)


def _nearest(in_world: Points, end: Vector) -> int:
    distances = np.linalg.norm(in_world - end, axis=1)
    if distances.min(initial=np.inf) > _FARTHEST:
        x, y, z = end
        raise InputError(
            f"No point of the scan lies within {_FARTHEST * 1e3:.0f} mm of {x:g},{y:g},{z:g} m; "
            "click both ends on the model's page (murkscan view), which shows them in metres."
        )
    return int(distances.argmin())


def _measure(ends: Profile, in_world: Points, trajectory: Trajectory, rig: Rig) -> Length:
    """Give the length between two points of a profile, with both parts of its uncertainty."""
    along = in_world - trajectory.transform(np.zeros_like(in_world), ends.time)
    rays = along / np.linalg.norm(along, axis=1, keepdims=True)
    shifts = shifts_in_world(ends, trajectory, rig)
    return measure_length(in_world, rays * ends.sigma[:, None], shifts)
