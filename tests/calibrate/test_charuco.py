import cv2
import numpy as np
import pytest

from murkscan.calibrate import Chessboard, calibrate_camera
from murkscan.calibrate.board.charuco import Markers, find_charuco
from murkscan.errors import InputError
from murkscan.optics import back_project, project
from murkscan.types.camera import Camera
from murkscan.types.pose import Pose

from .boards import rotation

BOARD = Chessboard(9, 6, 0.03)
MARKERS = Markers(0.022, "4X4_50")
CAMERA = Camera((640, 480), (620.0, 622.0), (322.0, 236.0), np.array([-0.1, 0.02, 0.0, 0.0, 0.0]))
TILTS = [(30, 0), (-30, 5), (0, 30), (5, -30), (20, 20), (-20, -20), (20, -20), (-25, 15)]
DOTS = 40
"""Dots a square in the printed board."""


@pytest.fixture(scope="module")
def print_out():
    dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50)
    pattern = cv2.aruco.CharucoBoard((10, 7), BOARD.square, MARKERS.size, dictionary)
    return pattern.generateImage((10 * DOTS, 7 * DOTS), marginSize=0)


@pytest.fixture(scope="module")
def photograph(print_out):
    """Look up each pixel's dot, of 4 x 4 rays, and blur as a lens does."""
    width, height = CAMERA.size
    v, u = np.mgrid[: 4 * height, : 4 * width]
    pixels = (np.stack([u.ravel(), v.ravel()], axis=1) + 0.5) / 4 - 0.5
    rays = back_project(CAMERA, pixels).directions

    def photograph(pose):
        normal, middle = pose.rotation[:, 2], pose.translation
        points = pose.inverse() @ (rays * ((normal @ middle) / (rays @ normal))[:, None])
        x, y = ((points[:, :2] / BOARD.square + 1) * DOTS).T
        inside = (x >= 0) & (x < 10 * DOTS) & (y >= 0) & (y < 7 * DOTS)
        column = np.clip(x.astype(int), 0, 10 * DOTS - 1)
        row = np.clip(y.astype(int), 0, 7 * DOTS - 1)
        level = np.where(inside, 30 + 0.7 * print_out[row, column], 120.0)
        level = level.reshape(height, 4, width, 4).mean(axis=(1, 3))
        return np.round(cv2.GaussianBlur(level, (0, 0), 0.8)).astype(np.uint8)

    return photograph


def hold(tilt, aside=(0.0, 0.0), depth=0.42):
    turned = rotation(*tilt, 0)
    return Pose(turned, np.array([*aside, depth]) - turned @ BOARD.points().mean(axis=0))


@pytest.fixture(scope="module")
def views(photograph):
    poses = [hold(tilt, aside) for tilt, aside in zip(TILTS, [(0.06, 0.03), (-0.08, 0.02)] * 4)]  # noqa: B905
    return poses, [
        find_charuco(photograph(pose), BOARD, MARKERS, name=f"{i}") for i, pose in enumerate(poses)
    ]


def test_corners_are_found_where_they_are_and_numbered_rightly(views):
    for pose, view in zip(*views, strict=True):
        truth = project(CAMERA, pose @ BOARD.points()[view.numbers])
        errors = np.linalg.norm(view.corners - truth, axis=1)
        # 0.1 px along u and along v: what the other tests take for the noise of a corner.
        assert np.sqrt(np.mean(errors**2)) < 0.1 * np.sqrt(2)


def test_a_board_half_out_of_the_picture_is_used_in_part(photograph):
    pose = hold((20, 10), aside=(0.17, 0.0))
    view = find_charuco(photograph(pose), BOARD, MARKERS)
    assert 8 <= len(view.numbers) < BOARD.num_corners
    truth = project(CAMERA, pose @ BOARD.points()[view.numbers])
    assert np.abs(view.corners - truth).max() < 0.3


def test_a_camera_is_calibrated_on_parts_of_boards(views):
    _, seen = views
    found = calibrate_camera(seen, BOARD, CAMERA.size)
    assert found.rms < 0.15
    error = np.array(found.rig.camera.focal_length) - CAMERA.focal_length
    assert np.all(np.abs(error) < 4 * found.sigma[:2])
    assert np.all(found.sigma[:2] < 0.01 * 620)


def test_a_photo_without_a_board_gives_none():
    empty = np.full((480, 640), 128, np.uint8)
    assert not find_charuco(empty, BOARD, MARKERS).is_found


def test_markers_that_cannot_be_are_refused():
    photo = np.full((480, 640), 128, np.uint8)
    with pytest.raises(InputError, match="no dictionary of markers 'QR'"):
        Markers(0.02, "QR")
    with pytest.raises(InputError, match="do not fit into squares"):
        find_charuco(photo, BOARD, Markers(0.03))
    with pytest.raises(InputError, match="has 52 markers, but 4X4_50 has only 50"):
        find_charuco(photo, Chessboard(12, 7, 0.03), MARKERS)
