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
from ..types.rig import Rig
from .adjust import Adjustment, adjust
from .board import Chessboard
from .parameters import INTRINSICS
from .sighting import Sighting
from .tilt import refuse_parallel_boards
from .view import BoardView, as_opencv
from .worth import Worth

PARAMETERS = ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3")
"""Names of a camera's parameters, in the order of `CameraCalibration.covariance`."""
MIN_VIEWS = 4
"""Views below which no camera is calibrated."""
_MAX_FOCAL_SIGMA = 0.05
"""Standard deviation of the focal length, over itself, above which it is not determined.

On simulated boards healthy sets stay below 0.03, even four views, and sets of parallel boards lie
between 0.03 and many times 1; those that slip under are caught by the tilt.
"""
_MAX_SIGMA_WITHOUT = 0.1
"""The same for what is left without any one view."""
_OUTLIER = 3.0
"""A view whose RMS is so many times the median is left out."""
_MAX_OUTLIERS = 0.25
"""Share of the views that may be left out."""


@dataclass(frozen=True, eq=False)
class CameraCalibration:
    """A camera, and what it is worth."""

    camera: Camera
    """The camera."""
    views: tuple[BoardView, ...]
    """The views that it was calibrated on."""
    camera_from_boards: tuple[Pose, ...]
    """Where the board was in each view."""
    residuals: tuple[Float[np.ndarray, "_ 2"], ...]
    """Corner as found minus corner as projected, of each view [px]."""
    covariance: Float[np.ndarray, "9 9"]
    """Of `PARAMETERS`, told from the residuals and from how much the views disagree."""
    left_out: tuple[BoardView, ...]
    """Views left out, since they fit far worse than the others."""
    adjustment: Adjustment
    """The same with what hangs on one view alone, and the rig that carries it."""

    @property
    def rig(self) -> Rig:
        """The camera with its covariance, as a rig in air."""
        return self.adjustment.rig

    def sightings(self, board: Chessboard) -> tuple[Sighting, ...]:
        """Give the views with the board where it was found to be."""
        flat = board.points()
        return tuple(
            Sighting(view.name, view.corners, view.places(flat), pose)
            for view, pose in zip(self.views, self.camera_from_boards, strict=True)
        )

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
    found = adjust(Rig(fit.camera), fit.sightings(board), INTRINSICS)
    worth = found.worth
    camera, covariance = found.rig.camera, worth.covariance.matrix
    sigma = float(np.sqrt(covariance[0, 0]))
    if sigma > _MAX_FOCAL_SIGMA * camera.focal_length[0]:
        raise Degenerate(
            f"The {len(fit.views)} views do not determine the focal length: with RMS "
            f"{found.corner_sigma:.2f} px it comes out as {camera.focal_length[0]:.0f} ± "
            f"{sigma:.0f} px. Add views with the board tilted by 20 to 40 degrees to the left, the "
            "right, the top and the bottom, in different parts of the picture."
        )
    _refuse_one_photo(worth, fit.views, camera.focal_length[0])
    return CameraCalibration(
        camera, fit.views, found.camera_from_boards, found.corner_residuals, covariance, left_out,
        found,
    )  # fmt: skip


def _refuse_one_photo(worth: Worth, views: Sequence[BoardView], focal_length: float) -> None:
    """Refuse a focal length that one view alone tells, such as the one tilted among parallel."""
    worst = int(np.argmax(worth.sigma_without_photo[:, 0]))
    sigma = float(worth.sigma_without_photo[worst, 0])
    if sigma <= _MAX_SIGMA_WITHOUT * focal_length:
        return
    raise Degenerate(
        f"The {len(views)} views do not determine the focal length: it hangs on "
        f"{views[worst].name} alone, without which it would be {focal_length:.0f} ± {sigma:.0f} "
        "px. Add views with the board tilted by 20 to 40 degrees to the left, the right, the top "
        "and the bottom."
    )


def _check_views(used: Sequence[BoardView], num_tried: int, board: Chessboard) -> None:
    for view in used:
        if len(view.corners) != (board.num_corners if view.numbers is None else len(view.numbers)):
            raise InputError(
                f"{view.name} has {len(view.corners)} corners but a {board} board has "
                f"{board.num_corners}; find its corners again for this board."
            )
    if len(used) < MIN_VIEWS:
        raise NotEnoughData(
            f"Need at least {MIN_VIEWS} views of the {board} board, better 15, found it in "
            f"{len(used)} of {num_tried}. Take photos of the whole board, each tilted another way."
        )


@dataclass(frozen=True, eq=False)
class _PlainFit:
    """A camera as OpenCV fits it, all corners alike: where the adjustment starts."""

    camera: Camera
    views: tuple[BoardView, ...]
    camera_from_boards: tuple[Pose, ...]
    view_rms: tuple[float, ...]

    def sightings(self, board: Chessboard) -> list[Sighting]:
        flat = board.points()
        return [
            Sighting(view.name, view.corners, view.places(flat), pose)
            for view, pose in zip(self.views, self.camera_from_boards, strict=True)
        ]


def _fit_without_outliers(
    views: Sequence[BoardView], board: Chessboard, size: tuple[int, int]
) -> tuple[_PlainFit, tuple[BoardView, ...]]:
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


def _fit(views: Sequence[BoardView], board: Chessboard, size: tuple[int, int]) -> _PlainFit:
    flat = board.points()
    _, matrix, distortion, turns, shifts = cv2.calibrateCamera(
        *as_opencv(views, flat), size, None, None
    )
    camera = Camera(
        size=size,
        focal_length=(float(matrix[0, 0]), float(matrix[1, 1])),
        principal_point=(float(matrix[0, 2]), float(matrix[1, 2])),
        distortion=np.ravel(distortion)[:5].astype(np.float64),
    )
    poses = tuple(_as_pose(turn, shift) for turn, shift in zip(turns, shifts, strict=True))
    rms = tuple(
        _rms(view.corners - _project(camera, turn, shift, view.places(flat)))
        for view, turn, shift in zip(views, turns, shifts, strict=True)
    )
    return _PlainFit(camera, tuple(views), poses, rms)


def _project(camera: Camera, turn: np.ndarray, shift: np.ndarray, points: Points) -> Pixels:
    pixels, _ = cv2.projectPoints(points, turn, shift, camera.as_matrix(), camera.distortion)
    return pixels.reshape(-1, 2)


def _as_pose(turn: np.ndarray, shift: np.ndarray) -> Pose:
    return Pose(cv2.Rodrigues(turn)[0].astype(np.float64), np.ravel(shift).astype(np.float64))


def _rms(residuals: Pixels) -> float:
    return float(np.sqrt(np.mean(np.sum(residuals**2, axis=1))))
