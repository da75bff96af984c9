from dataclasses import replace

import numpy as np
import pytest

from murkscan.calibrate import BoardView
from murkscan.calibrate.check import LinedBoard, check_on_boards, judge_boards, judge_length
from murkscan.errors import InputError, NotEnoughData
from murkscan.optics import perturb_rig
from murkscan.types.rig_covariance import RigCovariance
from murkscan.types.water import Water

from .boards import BOARD
from .underwater import FLAT, SHEET, rig_behind, see_stripes

pytestmark = pytest.mark.without_types

RIG = rig_behind(FLAT, SHEET)
NAMES = ("laser[0].normal[0]", "laser[0].distance", "camera.focal_length[0]", "water.index")
COVARIANCE = RigCovariance(NAMES, np.diag([1e-3, 2e-4, 1.0, 2e-4]) ** 2)


def photograph(noise, count=6):
    seen = see_stripes(np.random.default_rng(3), RIG, count, noise=noise)
    return [LinedBoard(BoardView(s.name, s.corners), s.stripe) for s in seen]


def test_without_noise_the_known_size_comes_out():
    check = check_on_boards(photograph(0.0), BOARD, RIG)
    # Corners are met to 1e-7 px by the poses; through a port that is nanometres of 30 mm.
    np.testing.assert_allclose(check.squares, BOARD.square, rtol=1e-6)
    assert check.sigma_common is None


def test_a_board_that_is_larger_than_said_measures_larger():
    small = replace(BOARD, square=0.98 * BOARD.square)
    check = check_on_boards(photograph(0.0), small, RIG)
    assert check.measured == pytest.approx(BOARD.square, rel=1e-5)


def test_the_rig_s_own_part_is_what_each_error_does_alone():
    photos = photograph(0.0, 3)
    stated = check_on_boards(photos, BOARD, replace(RIG, covariance=COVARIANCE)).sigma_common
    slopes = []
    for name, sigma in zip(NAMES, COVARIANCE.sigma, strict=True):
        sides = [
            check_on_boards(photos, BOARD, perturb_rig(RIG, [name], np.array([step]))).measured
            for step in (sigma, -sigma)
        ]
        slopes.append((sides[0] - sides[1]) / 2)
    # Errors are independent here; over a whole deviation the size bends by less than 1 %.
    assert stated == pytest.approx(np.linalg.norm(slopes), rel=0.01)


def test_salt_water_taken_for_fresh_is_found_out():
    sea = replace(RIG, water=Water(20.0, 35.0))
    sea = replace(sea, covariance=RigCovariance(NAMES[:1], np.array([[1e-10]])))
    check = check_on_boards(photograph(0.02), BOARD, sea)
    verdict = judge_length(check.measured, check.known, check.sigma, is_common_known=True)
    # The index is off by 0.0065, that of the rays' angles by 0.5 %.
    assert abs(check.measured / check.known - 1) > 1e-3
    assert not verdict.is_good
    assert "Check that [water]" in str(verdict)


def test_squares_that_another_camera_saw_measure_nothing():
    photos = photograph(0.1, 3)
    assert judge_boards(check_on_boards(photos, BOARD, RIG), RIG).is_usable
    camera = replace(RIG.camera, distortion=RIG.camera.distortion + np.eye(5)[0] / 2)
    other = replace(RIG, camera=camera)
    verdict = judge_boards(check_on_boards(photos, BOARD, other), other)
    assert not verdict.is_usable
    assert "corners are off by" in str(verdict)


def test_two_photos_are_too_few():
    with pytest.raises(NotEnoughData, match=r"3 photos or more, found it in 2 of 3"):
        photos = photograph(0.0, 3)
        check_on_boards([*photos[:2], replace(photos[2], stripe=np.zeros((0, 2)))], BOARD, RIG)


def test_squares_in_another_unit_are_found_out():
    with pytest.raises(InputError, match=r"squares of 60 mm come out as 30.* check --square-mm"):
        check_on_boards(photograph(0.0, 3), replace(BOARD, square=0.06), RIG)


def test_a_length_within_two_deviations_agrees():
    assert judge_length(0.5011, 0.5, 0.001, is_common_known=True).is_good
    off = judge_length(0.503, 0.5, 0.001, is_common_known=True)
    assert "0.60% too long" in str(off)
    assert "3.0 standard deviations" in str(off)
    assert "no covariance" in str(judge_length(0.497, 0.5, 0.001, is_common_known=False))
