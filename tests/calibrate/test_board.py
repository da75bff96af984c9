import numpy as np
import pytest

from murkscan.calibrate import Chessboard, Margin
from murkscan.errors import InputError

BOARD = Chessboard(4, 3, 0.01)
NO_MARGIN = Margin(0.0, 0.0, 0.0, 0.0)


def is_on_paper(x, y, margin=NO_MARGIN, rim=0.001, is_first_dark=True):
    points = np.array([[x, y, 0.0]]) * 0.01
    return bool(BOARD.is_on_paper(points, margin, rim=rim, is_first_dark=is_first_dark)[0])


def test_corners_run_row_after_row():
    points = BOARD.points()
    assert len(points) == BOARD.num_corners == 12
    np.testing.assert_allclose(points[[0, 1, 4]], [[0, 0, 0], [0.01, 0, 0], [0, 0.01, 0]])


def test_light_squares_are_paper_and_dark_ones_are_not():
    assert not is_on_paper(-0.5, -0.5)
    assert is_on_paper(0.5, -0.5)
    assert not is_on_paper(0.5, 0.5)
    assert is_on_paper(-0.5, -0.5, is_first_dark=False)
    assert not is_on_paper(0.5, -0.5, is_first_dark=False)


def test_a_rim_beside_every_edge_is_masked():
    assert is_on_paper(0.5, -0.85)
    assert not is_on_paper(0.5, -0.95)
    assert not is_on_paper(0.05, -0.5)


def test_the_margin_counts_from_the_squares_on_each_side():
    margin = Margin(left=0.02, right=0.0, top=0.0, bottom=0.01)
    assert is_on_paper(-2.8, 1.0, margin)
    assert not is_on_paper(-2.95, 1.0, margin)
    assert not is_on_paper(4.5, 1.0, margin)
    assert is_on_paper(1.0, 3.5, margin)
    assert not is_on_paper(1.0, -1.5, margin)
    assert not is_on_paper(np.nan, np.nan, margin)


@pytest.mark.parametrize("square", [0.0, -0.03, np.nan, np.inf])
def test_squares_without_a_size_are_refused(square):
    with pytest.raises(InputError, match="larger than 0 mm"):
        Chessboard(9, 6, square)


def test_a_board_of_too_few_corners_is_refused():
    with pytest.raises(InputError, match="at least 3x3 inner corners, got 9x2"):
        Chessboard(9, 2, 0.03)


def test_a_negative_margin_is_refused():
    with pytest.raises(InputError, match="0 or more on each side"):
        Margin(0.1, -0.01, 0.0, 0.0)
