"""Boards photographed by a known camera, without pictures: corners with noise."""

import cv2
import numpy as np

from murkscan.calibrate import BoardView, Chessboard
from murkscan.optics import project
from murkscan.types.camera import Camera
from murkscan.types.pose import Pose

BOARD = Chessboard(9, 6, 0.03)
CAMERA = Camera(
    size=(640, 480),
    focal_length=(800.0, 805.0),
    principal_point=(325.0, 234.0),
    distortion=np.array([-0.15, 0.05, 0.001, -0.0005, 0.0]),
)


def rotation(x, y, z):
    """Turn by z in the board's own plane, then tilt about y and x [degrees]."""
    turns = [
        cv2.Rodrigues(np.radians(angle) * axis)[0]
        for angle, axis in zip((x, y, z), np.eye(3), strict=True)
    ]
    return turns[0] @ turns[1] @ turns[2]


def poses(random, tilts, camera=CAMERA, board=BOARD):
    """Hold the board so that the camera sees all of it, at the given tilts [degrees]."""
    (width, height), flat = camera.size, board.points()
    for x, y in tilts:
        while True:
            turned = rotation(x, y, random.uniform(-25, 25))
            depth = random.uniform(0.5, 0.9) * camera.focal_length[0] / 800
            aside = random.uniform(-0.2, 0.2, 2) * depth * np.array(camera.size)
            place = np.array([*aside / camera.focal_length, depth])
            camera_from_board = Pose(turned, place - turned @ flat.mean(axis=0))
            seen = project(camera, camera_from_board @ flat)
            if np.all((seen > 0) & (seen < [width - 1, height - 1])):
                yield camera_from_board
                break


def views(random, tilts, noise=0.1, camera=CAMERA, board=BOARD):
    """Give the corners that the camera sees, with noise [px]."""
    return [
        BoardView(
            f"photo{number}",
            project(camera, pose @ board.points()) + random.normal(0, noise, (54, 2)),
        )
        for number, pose in enumerate(poses(random, tilts, camera, board))
    ]


def draw(camera_from_board, camera=CAMERA, board=BOARD, margin=1.0):
    """Render a photo of the board, grey, with soft edges, by looking up each pixel's square."""
    width, height = camera.size
    fine = 3
    v, u = np.mgrid[: height * fine, : width * fine]
    pixels = (np.stack([u.ravel(), v.ravel()], axis=1) + 0.5) / fine - 0.5
    from murkscan.calibrate.board.stripe import locate_on_board

    x, y, _ = (camera_from_board.inverse() @ locate_on_board(camera, pixels, camera_from_board)).T
    i, j = np.floor(x / board.square), np.floor(y / board.square)
    inside = (i >= -1) & (i < board.columns) & (j >= -1) & (j < board.rows)
    on_paper = (
        (x > -(1 + margin) * board.square)
        & (x < (board.columns + margin) * board.square)
        & (y > -(1 + margin) * board.square)
        & (y < (board.rows + margin) * board.square)
    )
    level = np.where(inside & ((i + j) % 2 == 0), 30.0, 200.0)
    level = np.where(on_paper, level, 90.0).reshape(height, fine, width, fine).mean(axis=(1, 3))
    return cv2.GaussianBlur(level, (0, 0), 0.7), (x, y)
