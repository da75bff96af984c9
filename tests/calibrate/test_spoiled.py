"""What spoils a photo of a board is named."""

import cv2
import numpy as np
import pytest

from murkscan.calibrate import Chessboard
from murkscan.calibrate.board.corners import find_board
from murkscan.calibrate.board.spoiled import name_spoiler
from murkscan.survey.calibrate import doubt_square

BOARD = Chessboard(9, 6, 0.03)


def photograph(left=60.0, top=50.0, pitch=20.0):
    """Draw the board, soft as a lens makes it."""
    v, u = np.mgrid[:960, :1280] / 4
    column, row = np.floor((u - left) / pitch), np.floor((v - top) / pitch)
    inside = (column >= 0) & (column <= 9) & (row >= 0) & (row <= 6)
    drawn = np.where(inside & ((column + row) % 2 == 0), 40.0, 180.0)
    small = cv2.resize(drawn, (320, 240), interpolation=cv2.INTER_AREA)
    noise = np.random.default_rng(0).normal(0, 1, small.shape)
    return np.clip(cv2.GaussianBlur(small, (0, 0), 0.7) + noise, 0, 255).astype(np.uint8)


def name(photo):
    view = find_board(photo, BOARD)
    return name_spoiler(photo, view, BOARD) if view.is_found else view.reason


def test_a_good_photo_is_spoilt_by_nothing():
    assert find_board(photograph(), BOARD).is_found
    assert name(photograph()) == ""


@pytest.mark.parametrize("radius", [30, 90])
def test_glare_is_named_whether_it_hides_some_corners_or_all(radius):
    assert "glare" in name(cv2.circle(photograph(), (150, 120), radius, 255, -1))


def test_blur_is_named():
    assert "blurred" in name(cv2.GaussianBlur(photograph(), (0, 0), 7.0))


@pytest.mark.parametrize("left", [-70.0, -130.0])
def test_a_board_that_the_edge_cuts_off_is_named(left):
    assert "edge cuts" in name(photograph(left=left))


def test_a_wall_is_named_nothing_but_no_board():
    wall = np.random.default_rng(0).integers(80, 120, (240, 320)).astype(np.uint8)
    assert name(wall) == "shows no chessboard"


def test_squares_of_another_size_than_the_cameras_are_doubted():
    tables = {"calibration": {"camera": {"board": "9x6", "square_mm": 33.0}}}
    (said,) = doubt_square(BOARD, tables, "laser")
    assert "30 mm" in said
    assert "33 mm" in said
    assert list(doubt_square(Chessboard(9, 6, 0.033), tables, "laser")) == []
    assert list(doubt_square(Chessboard(8, 6, 0.03), tables, "laser")) == []
    assert list(doubt_square(BOARD, tables, "camera")) == []
    assert list(doubt_square(BOARD, {}, "laser")) == []
