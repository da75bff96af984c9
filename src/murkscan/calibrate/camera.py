"""A camera from photos of a chessboard."""

from collections.abc import Sequence
from dataclasses import replace

import cv2
import numpy as np

from ..errors import Degenerate, InputError, NotEnoughData
from ..types.camera import Camera
from ..types.pose import Pose
from ..types.rig import Rig
from .adjust.covariance import Worth
from .adjust.observations import Sighting
from .adjust.parameters import INTRINSICS
from .adjust.solve import adjust, rms_of
from .board.chessboard import Chessboard
from .board.tilt import refuse_parallel_boards
from .board.view import BoardView, as_opencv
from .calibration import MIN_VIEWS, Calibration, find_outlier

_MAX_FOCAL_SIGMA = 0.05
"""Standard deviation of the focal length, over itself, above which it is not determined.

On simulated boards healthy sets stay below 0.03, even four views, and sets of parallel boards lie
between 0.03 and many times 1; those that slip under are caught by the tilt.
"""
_MAX_SIGMA_WITHOUT = 0.1
"""The same for what is left without any one view."""
_OUTLIER = 3.0
"""A view whose RMS is so many times the median is left out."""


def calibrate_camera(
    views: Sequence[BoardView], board: Chessboard, size: tuple[int, int]
) -> Calibration:
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
    left_out = list[str]()
    while True:
        camera, sightings, view_rms = _fit_plainly(used, board, size)
        worst = find_outlier(view_rms, len(left_out), outlier=_OUTLIER)
        if worst is None:
            break
        left_out.append(used.pop(worst).name)
    found = adjust(Rig(camera), sightings, INTRINSICS)
    focal_length, sigma = found.rig.camera.focal_length[0], float(found.sigma[0])
    if sigma > _MAX_FOCAL_SIGMA * focal_length:
        raise Degenerate(
            f"The {len(used)} views do not determine the focal length: with RMS "
            f"{found.corner_sigma:.2f} px it comes out as {focal_length:.0f} ± "
            f"{sigma:.0f} px. Add views with the board tilted by 20 to 40 degrees to the left, the "
            "right, the top and the bottom, in different parts of the picture."
        )
    _refuse_one_photo(found.worth, used, focal_length)
    calibration = Calibration.of("camera", found, INTRINSICS, sightings)
    return replace(calibration, left_out=tuple(left_out))


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


def _fit_plainly(
    views: Sequence[BoardView], board: Chessboard, size: tuple[int, int]
) -> tuple[Camera, list[Sighting], list[float]]:
    """Fit a camera as OpenCV does, all corners alike: where the adjustment starts.

    Returns:
        The camera, what each view shows, and the RMS of each view [px].
    """
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
    sightings, rms = [], []
    for view, turn, shift in zip(views, turns, shifts, strict=True):
        points = view.places(flat)
        seen, _ = cv2.projectPoints(points, turn, shift, matrix, distortion)
        rms.append(rms_of(view.corners - seen.reshape(-1, 2)))
        rotation = cv2.Rodrigues(turn)[0].astype(np.float64)
        pose = Pose(rotation, np.ravel(shift).astype(np.float64))
        sightings.append(Sighting(view.name, view.corners, points, pose))
    return camera, sightings, rms
