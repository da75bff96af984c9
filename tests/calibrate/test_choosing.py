"""Which pictures of a board before a live camera become photos."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

from murkscan.calibrate import BoardView, Chessboard
from murkscan.calibrate.board.choosing import PhotoChooser, edge_width
from murkscan.survey.photograph import SIGHT, take_photos

BOARD = Chessboard(9, 6, 0.01)
SQUARE = 30


def picture(left=60, top=60, blur=0.8):
    """Paint a board that faces the camera; and give the view of it."""
    squares = np.kron(np.indices((7, 10)).sum(axis=0) % 2, np.ones((SQUARE, SQUARE)))
    image = np.full((480, 640), 230.0)
    image[top : top + 7 * SQUARE, left : left + 10 * SQUARE] = 190 * squares + 40
    v, u = np.mgrid[1:7, 1:10] * SQUARE - 0.5
    corners = np.stack([u.ravel() + left, v.ravel() + top], axis=1)
    return gaussian_filter(image, blur).astype(np.uint8), BoardView("now", corners)


@pytest.mark.parametrize("blur", [1.0, 1.5, 2.5])
def test_the_width_of_edges_is_that_of_the_blur(blur):
    image, view = picture(blur=blur)
    # A step blurred by σ has its contrast over its steepest slope at σ √(2π); a pixel's width is
    # in the slope, which is measured between pixels.
    expected = np.sqrt(2 * np.pi) * np.hypot(blur, 1 / np.sqrt(12))
    assert edge_width(image, view, BOARD) == pytest.approx(expected, rel=0.08)


def test_a_board_is_taken_when_it_is_still_sharp_and_new():
    chooser = PhotoChooser(BOARD)
    here, there = picture(), picture(left=200)
    assert chooser.judge(here[1], here[0], 0.0) == "moves"
    assert chooser.judge(here[1], here[0], 0.1) == "take"
    chooser.take(here[1])
    assert chooser.judge(here[1], here[0], 0.2) == "is as before"
    assert chooser.judge(there[1], there[0], 0.3) == "moves"
    assert chooser.judge(there[1], gaussian_filter(there[0], 3.0), 0.4) == "is not sharp"
    assert chooser.judge(BoardView("now", np.zeros((0, 2))), there[0], 0.5) == "no board"
    assert chooser.judge(there[1], there[0], 0.6) == "moves"
    assert chooser.judge(there[1], there[0], 0.7) == "take"


def test_photos_are_kept_without_loss_and_what_is_there_stays(tmp_path):
    (tmp_path / "board001.png").write_bytes(b"mine")
    here, there = picture()[0], picture(left=200)[0]
    coming = [(image, 0.2 * k) for k, image in enumerate([here, here, here, there, there])]
    taken = take_photos(coming, BOARD, tmp_path, count=2)
    assert taken.names == ("board002.png", "board003.png")
    assert taken.is_enough
    assert (tmp_path / "board001.png").read_bytes() == b"mine"
    assert (tmp_path / SIGHT / "picture.jpg").exists()


def test_a_photo_that_is_asked_for_is_taken_as_it_is(tmp_path):
    (tmp_path / SIGHT).mkdir()
    (tmp_path / SIGHT / "take").touch()
    grey = np.full((480, 640), 90, np.uint8)
    taken = take_photos([(grey, 0.0), (grey, 1.0)], BOARD, tmp_path, count=2)
    assert taken.names == ("board001.png",)
    assert not taken.is_enough
