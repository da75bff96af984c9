"""Refraction against a real photograph: board corners seen through a tank of water."""

import cv2
import numpy as np
import pytest
from scipy.io import loadmat
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from murkscan.optics import project
from murkscan.types.camera import Camera
from murkscan.types.port import FlatPort, Layer
from murkscan.types.pose import Pose

INDEX = 1.33
"""Of the water, as the authors took it."""
DISTANCE = 0.2
"""From the camera to the tank [m]; behind the tank rays go on parallel to how they came, so that
it cannot be seen in the picture."""


@pytest.fixture(scope="module")
def tank(data):
    recorded = loadmat(data("water_tank") / "RealData.mat")
    matrix = recorded["KK"]
    camera = Camera((4000, 3000), (matrix[0, 0], matrix[1, 1]), (matrix[0, 2], matrix[1, 2]))
    measured = Pose(recorded["Rgt"], recorded["Tgt"].ravel() / 1e3)
    corners = np.ascontiguousarray(recorded["Pall"].T / 1e3)
    pixels = np.ascontiguousarray(recorded["CameraRays"][:2].T)
    return camera, measured, corners, pixels


def look_through(camera, normal_xy, thickness):
    normal = np.array([*normal_xy, 1.0])
    slab = FlatPort(normal / np.linalg.norm(normal), DISTANCE, (Layer(thickness, INDEX),))
    return Camera(camera.size, camera.focal_length, camera.principal_point, port=slab)


def as_pose(numbers):
    return Pose(Rotation.from_rotvec(numbers[:3]).as_matrix(), np.asarray(numbers[3:6]))


def rms(residuals):
    return np.sqrt(np.mean(np.sum(residuals.reshape(-1, 2) ** 2, axis=1)))


def fit_central(camera, corners, pixels):
    found, turn, shift = cv2.solvePnP(corners, pixels, camera.as_matrix(), np.zeros(5))
    assert found
    start = np.concatenate([turn.ravel(), shift.ravel()])
    return least_squares(
        lambda x: (project(camera, as_pose(x) @ corners) - pixels).ravel(), start, x_scale="jac"
    )


@pytest.fixture(scope="module")
def fitted(tank):
    """Give the least-squares answer, and which corners it was found from.

    Some corners of the recording lie a pixel beside their square. Such are left out that miss by
    more than four robust standard deviations, which none of 144 does by chance (e^-8 each).
    """
    camera, _, corners, pixels = tank

    def residuals(x, used):
        view = look_through(camera, x[6:8], x[8])
        return (project(view, as_pose(x) @ corners[used], 1.0) - pixels[used]).ravel()

    # From the pose of the best central camera: nothing of the measured one goes in.
    start = np.concatenate([fit_central(camera, corners, pixels).x, [0.0, 0.0, 0.15]])
    everything = np.ones(len(corners), dtype=bool)
    used = everything
    for _ in range(4):
        answer = least_squares(residuals, start, x_scale="jac", args=(used,))
        misses = np.linalg.norm(residuals(answer.x, everything).reshape(-1, 2), axis=1)
        # The median length of a Gaussian error in two directions is 1.1774 standard deviations.
        start, used = answer.x, misses <= 4 * np.median(misses) / 1.1774
    return answer, used


def test_a_central_camera_cannot_explain_the_tank(tank):
    camera, _, corners, pixels = tank
    # 14.3 px is the figure that was found independently for the best central camera.
    assert rms(fit_central(camera, corners, pixels).fun) == pytest.approx(14.3, abs=0.1)


def test_a_slab_of_water_explains_it_to_a_third_of_a_pixel(fitted):
    answer, used = fitted
    # The corner finder's own error; an independent fit has 0.38 px. With the mislocated corners,
    # all 144, it is 0.465 px.
    assert rms(answer.fun) <= 0.40
    assert used.sum() >= 130


def test_the_water_is_as_thick_as_the_tank(fitted):
    assert fitted[0].x[8] == pytest.approx(0.2568, abs=1e-3)


def test_the_boards_stand_where_they_were_measured(tank, fitted):
    measured, pose = tank[1], as_pose(fitted[0].x)
    turn = Rotation.from_matrix(measured.rotation.T @ pose.rotation).magnitude()
    assert np.degrees(turn) <= 0.1
    assert np.linalg.norm(measured.translation - pose.translation) <= 3e-3
