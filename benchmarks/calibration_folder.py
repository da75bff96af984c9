"""A calibration folder as it comes: 200 pictures of 1920 x 1080, 60 of them without a board.

Run: python benchmarks/calibration_folder.py
"""

import tempfile
import time
from pathlib import Path

import cv2
import numpy as np
from harness import Figure, tell

from murkscan.calibrate import Chessboard, find_board
from murkscan.survey.calibrate_camera import calibrate_camera_from_photos
from murkscan.types.camera import Camera
from murkscan.types.pose import Pose

BOARD = Chessboard(9, 6, 0.03)
CAMERA = Camera((1920, 1080), (1400.0, 1402.0), (955.0, 548.0))
FINE = 60
"""Pixels a square of the drawing that photos are made from."""
COUNT, WITHOUT = 200, 60
CUT = 0.25
"""Share of the boards that may run out of the picture."""


def main() -> None:
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch) / "photos"
        folder.mkdir()
        write_photos(folder)
        start, used = time.perf_counter(), time.process_time()
        result = calibrate_camera_from_photos(folder, BOARD, Path(scratch) / "rig.toml")
        spent, used = time.perf_counter() - start, time.process_time() - used
    camera, sigma = result.calibration.rig.camera, result.calibration.sigma
    off = float(np.max(np.abs(np.array(camera.focal_length) - CAMERA.focal_length) / sigma[:2]))
    tell(
        "calibration_folder",
        "A folder of 200 calibration photographs",
        [
            Figure("time, elapsed, with drawings and page", spent, "s", at_most=90.0),
            Figure("time, processor", used, "s"),
            Figure("a lens cap, processor time", time_one(np.zeros((1080, 1920))), "s", at_most=1),
            Figure("noise, processor time", time_one(noise(0)), "s", at_most=1),
            Figure("photos used of 140 with a board", len(result.calibration.sightings)),
            Figure(
                "pictures without a board that were taken for one",
                sum(int(s.name[:3]) < WITHOUT for s in result.calibration.sightings),
                at_most=0,
            ),
            Figure("focal length's error over its stated deviation", off),
        ],
        note="140 rendered photos of a 9x6 board, some running out of the picture, and "
        "20 each of black, noise and striped cloth, through `calibrate camera`.",
    )


def write_photos(folder: Path) -> None:
    """Render the photos: black, noise and cloth first, then boards."""
    random = np.random.default_rng(0)
    blanks = (np.zeros((1080, 1920)), None, cloth())
    for number in range(COUNT):
        if number < WITHOUT:
            blank = blanks[number % 3]
            photo = noise(number) if blank is None else blank + random.normal(0, 2, blank.shape)
        else:
            photo = render(hold(random), random)
        cv2.imwrite(str(folder / f"{number:03d}.jpg"), np.clip(photo, 0, 255).astype(np.uint8))


def noise(seed: int) -> np.ndarray:
    return np.random.default_rng(seed).integers(0, 255, (1080, 1920)).astype(float)


def cloth() -> np.ndarray:
    v, u = np.mgrid[:1080, :1920]
    return 120 + 60 * np.sin(u / 9) + 40 * np.sin((u + v) / 23)


def hold(random: np.random.Generator) -> Pose:
    """Hold the board within the picture, or partly out of it."""
    turn = cv2.Rodrigues(np.radians(random.uniform([-30, -30, -25], [30, 30, 25])))[0]
    depth = random.uniform(0.35, 0.7)
    room = 0.4 if random.uniform() < CUT else 0.15
    aside = random.uniform(-room, room, 2) * depth * np.array(CAMERA.size) / CAMERA.focal_length
    return Pose(turn, np.array([*aside, depth]) - turn @ BOARD.points().mean(axis=0))


def render(pose: Pose, random: np.random.Generator) -> np.ndarray:
    """Lay a fine drawing of the board into the picture by its homography; soften, add noise."""
    squares = np.indices((BOARD.rows + 1, BOARD.columns + 1)).sum(axis=0) % 2
    drawing = np.pad(np.where(squares == 0, 30.0, 200.0), 1, constant_values=200.0)
    drawing = np.kron(drawing, np.ones((FINE, FINE))).astype(np.float32)
    # Pixel 0's middle lies half a fine pixel inside; the drawing begins two squares before the
    # first corner.
    scale = BOARD.square / FINE
    board_from_drawing = np.array(
        [[scale, 0, (0.5 - 2 * FINE) * scale], [0, scale, (0.5 - 2 * FINE) * scale], [0, 0, 1]]
    )
    picture_from_board = CAMERA.as_matrix() @ np.column_stack(
        [pose.rotation[:, :2], pose.translation]
    )
    level = cv2.warpPerspective(
        drawing, picture_from_board @ board_from_drawing, CAMERA.size, borderValue=70.0
    )
    return cv2.GaussianBlur(level, (0, 0), 1.0) + random.normal(0, 2, level.shape)


def time_one(photo: np.ndarray) -> float:
    grey = photo.astype(np.uint8)
    find_board(grey, BOARD)
    start = time.process_time()
    find_board(grey, BOARD)
    return time.process_time() - start


if __name__ == "__main__":
    main()
