"""A camera from photos of a chessboard."""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Float

from ..errors import Degenerate, InputError, NotEnoughData
from ..types.arrays import Pixels, Points, Scalars
from ..types.camera import Camera
from ..types.pose import Pose
from .board import Chessboard
from .tilt import refuse_parallel_boards
from .view import BoardView, as_opencv

PARAMETERS = ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3")
"""Names of a camera's parameters, in the order of `CameraCalibration.covariance`."""
MIN_VIEWS = 4
"""Views below which no camera is calibrated."""
_MAX_FOCAL_SIGMA = 0.05
"""Standard deviation of the focal length, over itself, above which it is not determined.

On simulated boards healthy sets stay below 0.03, even four views, and sets of parallel boards lie
between 0.03 and many times 1; those that slip under are caught by the tilt.
"""
_OUTLIER = 3.0
"""A view whose RMS is so many times the median is left out."""
_MAX_OUTLIERS = 0.25
"""Share of the views that may be left out."""
_MAX_FOLDS = 24
"""Jackknife groups at most; more would only take longer."""


@dataclass(frozen=True, eq=False)
class CameraCalibration:
    """A camera, and what it is worth."""

    camera: Camera
    """The camera."""
    views: tuple[BoardView, ...]
    """The views that it was calibrated on."""
    camera_from_boards: tuple[Pose, ...]
    """Where the board was in each view."""
    residuals: tuple[Pixels, ...]
    """Corner as found minus corner as projected, of each view [px]."""
    covariance: Float[np.ndarray, "9 9"]
    """Of `PARAMETERS`: how they vary together is the jackknife's; how much each does is OpenCV's
    or the jackknife's, the larger. From fewer than 10 views it is singular."""
    left_out: tuple[BoardView, ...]
    """Views left out, since they fit far worse than the others."""

    @property
    def sigma(self) -> Scalars:
        """Standard deviation of each of `PARAMETERS`."""
        return np.sqrt(np.diag(self.covariance))

    @property
    def rms(self) -> float:
        """Root mean square distance of a corner from its projection [px]."""
        return _rms(np.concatenate(self.residuals))

    @property
    def view_rms(self) -> tuple[float, ...]:
        """The same for each view [px]."""
        return tuple(_rms(residuals) for residuals in self.residuals)


def calibrate_camera(
    views: Sequence[BoardView], board: Chessboard, size: tuple[int, int]
) -> CameraCalibration:
    """Calibrate a camera on views of one board.

    A low RMS does not make a camera: boards that are parallel fit any focal length. So sets whose
    boards do not differ in tilt are refused, and so are those whose focal length changes when
    views are left out, however low the RMS is.

    Args:
        views: The views; those in which the board was not found are passed over.
        board: The board.
        size: Width and height of the photos [px].

    Raises:
        InputError: A view has another number of corners than the board.
        NotEnoughData: The board was found in fewer than 4 views.
        Degenerate: The views do not determine the camera; the message says why and what to do.

    References:
        Zhang, A flexible new technique for camera calibration, TPAMI 22(11), 2000; its section 3.4
        on degenerate sets. Efron, The jackknife, the bootstrap and other resampling plans, 1982.
    """
    used = [view for view in views if view.is_found]
    _check_views(used, len(views), board)
    refuse_parallel_boards(used, board, size)
    fit, left_out = _fit_without_outliers(used, board, size)
    covariance = _widen(_jackknife_covariance(fit.views, board, size), fit.sigma)
    sigma = np.sqrt(np.diag(covariance))
    if sigma[0] > _MAX_FOCAL_SIGMA * fit.camera.focal_length[0]:
        raise Degenerate(
            f"The {len(fit.views)} views do not determine the focal length: with RMS "
            f"{fit.rms:.2f} px it comes out as {fit.camera.focal_length[0]:.0f} ± {sigma[0]:.0f} "
            "px. Add views with the board tilted by 20 to 40 degrees to the left, the right, "
            "the top and the bottom, in different parts of the picture."
        )
    return CameraCalibration(
        fit.camera, fit.views, fit.camera_from_boards, fit.residuals, covariance, left_out
    )


def locate_board(view: BoardView, board: Chessboard, camera: Camera) -> tuple[Pose, Pixels]:
    """Find camera_from_board of one view of a calibrated camera, and its residuals [px]."""
    flat = board.points()
    _, turn, shift = cv2.solvePnP(
        flat, view.corners, camera.as_matrix(), camera.distortion, flags=cv2.SOLVEPNP_IPPE
    )
    turn, shift = cv2.solvePnPRefineLM(
        flat, view.corners, camera.as_matrix(), camera.distortion, turn, shift
    )
    camera_from_board = _as_pose(turn, shift)
    return camera_from_board, view.corners - _project(camera, turn, shift, flat)


def _check_views(used: Sequence[BoardView], num_tried: int, board: Chessboard) -> None:
    for view in used:
        if len(view.corners) != board.num_corners:
            raise InputError(
                f"{view.name} has {len(view.corners)} corners but a {board} board has "
                f"{board.num_corners}; find its corners again for this board."
            )
    if len(used) < MIN_VIEWS:
        raise NotEnoughData(
            f"Need at least {MIN_VIEWS} views of the {board} board, better 15, found it in "
            f"{len(used)} of {num_tried}. Take photos of the whole board, each tilted another way."
        )


def _fit_without_outliers(
    views: Sequence[BoardView], board: Chessboard, size: tuple[int, int]
) -> tuple[CameraCalibration, tuple[BoardView, ...]]:
    """Fit, and fit again without the worst view while that stands out from the others."""
    kept, left_out = list(views), list[BoardView]()
    may_leave_out = min(int(_MAX_OUTLIERS * len(views)), len(views) - MIN_VIEWS)
    fit = _fit(kept, board, size)
    while len(left_out) < may_leave_out:
        worst = int(np.argmax(fit.view_rms))
        if fit.view_rms[worst] <= _OUTLIER * np.median(fit.view_rms):
            break
        left_out.append(kept.pop(worst))
        fit = _fit(kept, board, size)
    return fit, tuple(left_out)


def _fit(views: Sequence[BoardView], board: Chessboard, size: tuple[int, int]) -> CameraCalibration:
    flat = board.points()
    _, matrix, distortion, turns, shifts, sigma, _, _ = cv2.calibrateCameraExtended(
        *as_opencv(views, flat), size, None, None
    )
    camera = Camera(
        size=size,
        focal_length=(float(matrix[0, 0]), float(matrix[1, 1])),
        principal_point=(float(matrix[0, 2]), float(matrix[1, 2])),
        distortion=np.ravel(distortion)[:5].astype(np.float64),
    )
    poses = tuple(_as_pose(turn, shift) for turn, shift in zip(turns, shifts, strict=True))
    residuals = tuple(
        view.corners - _project(camera, turn, shift, flat)
        for view, turn, shift in zip(views, turns, shifts, strict=True)
    )
    formal = np.ravel(sigma)[: len(PARAMETERS)].astype(np.float64)
    return CameraCalibration(camera, tuple(views), poses, residuals, np.diag(formal**2), ())


def _jackknife_covariance(
    views: Sequence[BoardView], board: Chessboard, size: tuple[int, int]
) -> Float[np.ndarray, "9 9"]:
    """Give the covariance of the parameters from how they change without some views.

    OpenCV's own takes the corners of a view as independent, which those of a board that is not
    quite flat are not.
    """
    flat = board.points()
    num_folds = min(len(views), _MAX_FOLDS)
    estimates = []
    for fold in range(num_folds):
        rest = [view for i, view in enumerate(views) if i % num_folds != fold]
        _, matrix, distortion, _, _ = cv2.calibrateCamera(*as_opencv(rest, flat), size, None, None)
        lens = np.ravel(distortion)[:5]
        estimates.append([matrix[0, 0], matrix[1, 1], matrix[0, 2], matrix[1, 2], *lens])
    around = np.array(estimates) - np.mean(estimates, axis=0)
    return (num_folds - 1) / num_folds * around.T @ around


def _widen(covariance: Float[np.ndarray, "n n"], least: Scalars) -> Float[np.ndarray, "n n"]:
    """Raise standard deviations to at least these; the correlations stay."""
    sigma = np.sqrt(np.diag(covariance))
    wider = np.maximum(sigma, least)
    scale = np.divide(wider, sigma, out=np.zeros_like(sigma), where=sigma > 0)
    widened = covariance * np.outer(scale, scale)
    np.fill_diagonal(widened, wider**2)
    return widened


def _project(camera: Camera, turn: np.ndarray, shift: np.ndarray, points: Points) -> Pixels:
    pixels, _ = cv2.projectPoints(points, turn, shift, camera.as_matrix(), camera.distortion)
    return pixels.reshape(-1, 2)


def _as_pose(turn: np.ndarray, shift: np.ndarray) -> Pose:
    return Pose(cv2.Rodrigues(turn)[0].astype(np.float64), np.ravel(shift).astype(np.float64))


def _rms(residuals: Pixels) -> float:
    return float(np.sqrt(np.mean(np.sum(residuals**2, axis=1))))
