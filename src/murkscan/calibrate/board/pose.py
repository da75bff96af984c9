"""Where a board is that a camera saw, perhaps through a window."""

import cv2
import numpy as np
from jaxtyping import Float
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from ...optics import back_project, project
from ...types.arrays import Pixels, Points, Scalars
from ...types.camera import Camera
from ...types.pose import Pose


def locate_seen_board(
    corners: Pixels, points: Points, camera: Camera, index: float | None = None
) -> Pose:
    """Find camera_from_board of one view, port and water included.

    Starts as if all rays met in the optical centre, then adjusts the reprojection.

    Args:
        corners: The inner corners as found [px].
        points: The same in the board's frame [m].
        camera: The camera.
        index: Refractive index of what lies outside the camera's port; of no effect without one.
    """
    rays = back_project(camera, corners, index)
    central = rays.directions[:, :2] / rays.directions[:, 2:]
    _, turn, shift = cv2.solvePnP(points, central, np.eye(3), None, flags=cv2.SOLVEPNP_IPPE)

    def misfits(parameters: Float[np.ndarray, "6"]) -> Scalars:
        seen = project(camera, _as_pose(parameters) @ points, index)
        return np.ravel(np.nan_to_num(corners - seen, nan=1e3))

    start = np.concatenate([np.ravel(turn), np.ravel(shift)]).astype(np.float64)
    return _as_pose(least_squares(misfits, start, x_scale="jac").x)


def _as_pose(parameters: Float[np.ndarray, "6"]) -> Pose:
    return Pose(Rotation.from_rotvec(parameters[:3]).as_matrix(), parameters[3:].copy())
