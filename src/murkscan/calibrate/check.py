"""Whether a rig measures right: a board of known size, measured by the laser in its own water.

The corners alone tell a board's distance over its size: a board twice as large, twice as far,
looks the same. The laser's line on the board tells its distance by the sheet. Only one size of the
squares brings both together, and it must be the one that is known.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from ..errors import InputError, NotEnoughData
from ..optics import back_project, intersect_rays_with_sheet, perturb_rig, project
from ..optics.uncertainty import error_modes
from ..types.arrays import Pixels, Scalars
from ..types.plane import Plane
from ..types.pose import Pose
from ..types.rig import Rig
from .adjust.observations import index_of
from .adjust.solve import rms_of
from .board.chessboard import Chessboard
from .board.pose import locate_seen_board
from .board.view import BoardView
from .verdict import CalibrationVerdict, corners_misfit

MIN_PHOTOS = 3
"""Photos below which chance cannot be told from a wrong rig."""
_TRIED = 0.01
"""Growth of the squares from which the distance's derivative is taken."""
_NUM_STEPS = 3
"""Steps to the right size: one is enough for a pinhole, a port needs two."""
_STEP = 0.1
"""Size of a rig's error for the derivative, in its standard deviation."""
_FARTHEST_OFF = 0.3
"""Difference from the known size beyond which something else than the rig is wrong."""
_AGREES = 2.0
"""Standard deviations within which a measured length agrees with the known one."""


@dataclass(frozen=True, eq=False)
class LinedBoard:
    """One photo of the board with the laser's line on it."""

    view: BoardView
    """The board."""
    stripe: Float[np.ndarray, "_ 2"]
    """Stripe centres on the board's flat [px]."""

    def locate(self, board: Chessboard, rig: Rig) -> Pose:
        """Find camera_from_board, taking the board's size as true."""
        points = self.view.places(board.points())
        return locate_seen_board(self.view.corners, points, rig.camera, index_of(rig))

    def misfit(self, board: Chessboard, rig: Rig) -> Pixels:
        """Give corner as found minus corner as projected [px]."""
        points = self.locate(board, rig) @ self.view.places(board.points())
        return self.view.corners - project(rig.camera, points, index_of(rig))


@dataclass(frozen=True, eq=False)
class BoardCheck:
    """A board's known size beside the size that the rig measures."""

    known: float
    """Side of a square as it is known [m]."""
    names: tuple[str, ...]
    """The photos."""
    distances: Float[np.ndarray, "..."]
    """How far away the board was in each [m]."""
    squares: Float[np.ndarray, "..."]
    """Side of a square as each photo measures it [m]."""
    sigma_common: float | None
    """Standard deviation of their mean that follows from the rig's covariance [m]; None where it
    states none."""
    rms: float
    """Root mean square distance of a corner from its projection [px]."""

    @property
    def measured(self) -> float:
        """Mean side of a square [m]."""
        return float(np.mean(self.squares))

    @property
    def sigma_independent(self) -> float:
        """Standard deviation of the mean that follows from how the photos scatter [m]."""
        return float(np.std(self.squares, ddof=1) / np.sqrt(len(self.squares)))

    @property
    def sigma(self) -> float:
        """Standard deviation of the mean [m]."""
        return float(np.hypot(self.sigma_independent, self.sigma_common or 0.0))


def check_on_boards(
    photos: Sequence[LinedBoard], board: Chessboard, rig: Rig, laser: int = 0
) -> BoardCheck:
    """Measure the squares of a board with the laser, and say how sure that is.

    Args:
        photos: Photos of the board with the line on it, at the ranges of the scan, in its water.
        board: The board, with the known size of its squares.
        rig: The calibrated rig, in the water of the photos.
        laser: Number of the laser.

    Raises:
        NotEnoughData: Fewer than three photos show the board and the line on it.
        InputError: The size comes out wrong by more than 30 %: the square or a unit is.

    References:
        JCGM 100:2008, section 5.2, for the common part.
    """
    used = [photo for photo in photos if len(photo.stripe) > 0]
    if len(used) < MIN_PHOTOS:
        raise NotEnoughData(
            f"The check needs the line on the board's paper in {MIN_PHOTOS} photos or more, found "
            f"it in {len(used)} of {len(photos)}. Take photos with the line across the board, over "
            "the ranges that you scan at; --margin-mm says how far the paper runs on."
        )
    sizes = _measure(used, board, rig, laser)
    off = float(np.median(sizes))
    if not abs(off - 1) < _FARTHEST_OFF:
        raise InputError(
            f"The squares of {board.square * 1e3:g} mm come out as {off * board.square * 1e3:.4g} "
            "mm, which no calibration is off by: check --square-mm, the units of the rig file, and "
            "that the laser is the one that threw this line."
        )
    poses = [photo.locate(board, rig) for photo in used]
    middle = board.points().mean(axis=0)[None]
    return BoardCheck(
        known=board.square,
        names=tuple(photo.view.name for photo in used),
        distances=np.array([float(np.linalg.norm(pose @ middle)) for pose in poses]),
        squares=sizes * board.square,
        sigma_common=_common(used, board, rig, laser),
        rms=rms_of(np.concatenate([photo.misfit(board, rig) for photo in used])),
    )


def _common(photos: Sequence[LinedBoard], board: Chessboard, rig: Rig, laser: int) -> float | None:
    """Give how far the rig's own errors move the mean size of a square [m]."""
    seeing = replace(rig, covariance=rig.covariance.without("mount."))
    if not seeing.covariance.names:
        return None
    slopes = []
    for mode in error_modes(seeing.covariance).T:
        ahead, behind = (
            _measure(photos, board, perturb_rig(rig, seeing.covariance.names, step * mode), laser)
            for step in (_STEP, -_STEP)
        )
        slopes.append(float(np.mean(ahead - behind)) / (2 * _STEP))
    return board.square * float(np.linalg.norm(slopes))


def _measure(photos: Sequence[LinedBoard], board: Chessboard, rig: Rig, laser: int) -> Scalars:
    """Give the size of the squares in each photo, over the known one."""
    return np.array([_size_of(photo, board, rig, laser) for photo in photos])


def _size_of(photo: LinedBoard, board: Chessboard, rig: Rig, laser: int) -> float:
    """Find the size at which the board lies on the points that the laser measures: secant."""
    index = index_of(rig)
    points = intersect_rays_with_sheet(
        back_project(rig.camera, photo.stripe, index), rig.laser(laser), index
    )

    def gap(size: float) -> float:
        grown = replace(board, square=size * board.square)
        pose = photo.locate(grown, rig)
        plane = Plane.through(pose.translation, pose.rotation[:, 2])
        return float(np.nanmedian(plane.distance_to(points)))

    before, now = 1.0, 1.0 + _TRIED
    gap_before = gap(before)
    for _ in range(_NUM_STEPS):
        gap_now = gap(now)
        if gap_now == gap_before:
            break
        step = gap_now * (now - before) / (gap_now - gap_before)
        before, gap_before, now = now, gap_now, now - step
    return now


def judge_boards(check: BoardCheck, rig: Rig) -> CalibrationVerdict:
    """Judge a board's squares as measured, unless its corners do not fit the rig at all."""
    if corners_misfit(check.rms, rig.camera.focal_length[0]):
        advice = (
            f"The corners are off by {check.rms:.2f} px: this camera did not see these boards so, "
            "and squares on them measure nothing. Check that focus, zoom and picture size are "
            "those of the calibration, and that window and [water] are as the rig file says."
        )
        return CalibrationVerdict((advice,), "", is_usable=False)
    is_common_known = check.sigma_common is not None
    return judge_length(check.measured, check.known, check.sigma, is_common_known=is_common_known)


def judge_length(
    measured: float, known: float, sigma: float, *, is_common_known: bool
) -> CalibrationVerdict:
    """Judge a measured length beside the known one.

    Args:
        measured: The length as measured [m].
        known: The length as known [m].
        sigma: Standard deviation of the difference [m].
        is_common_known: Whether the rig's own part is in the deviation.
    """
    off = measured - known
    size = f"{measured * 1e3:.3f} ± {sigma * 1e3:.3f} mm (1σ) for {known * 1e3:.3f} mm"
    advice = []
    if abs(off) > _AGREES * sigma:
        longer = "long" if off > 0 else "short"
        advice.append(
            f"Lengths come out {abs(off / known):.2%} too {longer}: {size}, "
            f"{abs(off) / sigma:.1f} standard deviations."
        )
        advice.append(
            "Check that [water] is the water that this was seen in, then the port, then the "
            "calibration; a wrong square or a wrong ruler looks the same."
            if is_common_known
            else "The rig file states no covariance, so what the rig's own errors explain of it is "
            "not known; calibrate again to have one."
        )
    return CalibrationVerdict(tuple(advice), f"Good: lengths agree, {size}.")
