import numpy as np
import pytest

from murkscan.calibrate import BoardView, Chessboard, calibrate_camera, judge
from murkscan.errors import Degenerate, InputError, NotEnoughData
from murkscan.types.camera import Camera

from .boards import BOARD, CAMERA, views


def parameters(camera):
    return np.array([*camera.focal_length, *camera.principal_point, *camera.distortion])


def tilted(random, count, most):
    return random.uniform(-most, most, (count, 2))


def test_the_stated_deviations_and_correlations_are_true():
    """Of 12 calibrations x 9 parameters, errors over sigma spread as they should."""
    pulls, pulls_of_difference = [], []
    for seed in range(12):
        random = np.random.default_rng(seed)
        found = calibrate_camera(views(random, tilted(random, 16, 30)), BOARD, CAMERA.size)
        assert found.rms == pytest.approx(0.1 * np.sqrt(2), rel=0.1)
        error = parameters(found.rig.camera) - parameters(CAMERA)
        pulls.append(error / found.sigma)
        (fx_fx, fx_fy), (_, fy_fy) = found.rig.covariance.matrix[:2, :2]
        pulls_of_difference.append((error[0] - error[1]) / np.sqrt(fx_fx - 2 * fx_fy + fy_fy))
    # Jackknife sigmas of 16 views scatter by a fifth, and the larger of two is stated, so about
    # 1 or a little less; 12 x 9 correlated pulls leave some 0.2 of scatter to the RMS.
    assert 0.5 < np.sqrt(np.mean(np.square(pulls))) < 1.3
    assert np.abs(pulls).max() < 4.5
    # fx and fy err together, so their difference is known ten times better than either; 12 pulls
    # leave the RMS a scatter of a fifth, and with the correlations gone it would be 0.1.
    assert 0.4 < np.sqrt(np.mean(np.square(pulls_of_difference))) < 1.6


@pytest.mark.parametrize(
    ("tilts", "words"),
    [
        ([(0.0, 0.0)] * 12, "face the camera straight on"),
        ([(1.5, -1.0), (-1.2, 0.8), (0.3, 1.7), (-0.5, -1.6)] * 3, "face the camera straight on"),
        ([(20.0, 0.0)] * 12, "tilted alike"),
        ([(30.0, 20.0), (31.0, 20.5), (29.5, 19.0)] * 4, "tilted alike"),
    ],
)
@pytest.mark.parametrize("focal", [400.0, 800.0, 2500.0])
def test_parallel_boards_are_refused_with_reason_and_remedy(tilts, words, focal):
    camera = Camera(CAMERA.size, (focal, focal), (325.0, 234.0), CAMERA.distortion)
    seen = views(np.random.default_rng(4), tilts, camera=camera)
    with pytest.raises(Degenerate, match=words) as refusal:
        calibrate_camera(seen, BOARD, CAMERA.size)
    assert "tilted by 20 to 40 degrees" in str(refusal.value)


def test_one_tilted_board_among_parallel_ones_is_not_enough():
    tilts = [(25.0, 10.0)] + [(0.5, -0.5)] * 11
    with pytest.raises(Degenerate, match="do not determine the focal length"):
        calibrate_camera(views(np.random.default_rng(5), tilts), BOARD, CAMERA.size)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize(("count", "most"), [(4, 30), (6, 25), (15, 8), (15, 15), (25, 40)])
def test_healthy_sets_are_not_refused(seed, count, most):
    random = np.random.default_rng(100 + seed)
    found = calibrate_camera(views(random, tilted(random, count, most)), BOARD, CAMERA.size)
    # What passes is known to 5 % (the limit of refusal); 3 of those sigmas would be a lie.
    assert found.rig.camera.focal_length[0] == pytest.approx(800, abs=3 * found.sigma[0])
    assert found.sigma[0] < 0.05 * 800


def test_oblong_pixels_do_not_make_parallel_boards_pass_nor_healthy_ones_fail():
    """PAL pixels: 720 x 576 on a 4:3 picture."""
    camera = Camera((720, 576), (900.0, 985.0), (365.0, 280.0))
    random = np.random.default_rng(6)
    with pytest.raises(Degenerate, match="tilted by 20 to 40 degrees"):
        calibrate_camera(views(random, [(0.0, 0.0)] * 12, camera=camera), BOARD, camera.size)
    found = calibrate_camera(
        views(random, tilted(random, 16, 30), camera=camera), BOARD, camera.size
    )
    assert found.rig.camera.focal_length == pytest.approx((900, 985), rel=0.01)


def test_fewer_than_four_views_are_refused_with_counts():
    random = np.random.default_rng(7)
    seen = [*views(random, tilted(random, 3, 30)), *[BoardView("dark", np.zeros((0, 2)))] * 9]
    with pytest.raises(NotEnoughData, match="found it in 3 of 12"):
        calibrate_camera(seen, BOARD, CAMERA.size)


def test_few_views_are_a_warning_and_fifteen_are_not():
    random = np.random.default_rng(8)
    seen = views(random, tilted(random, 20, 30))
    few = judge(calibrate_camera(seen[:8], BOARD, CAMERA.size))
    assert not few.is_good
    assert "8 photos are few; take 15 or more" in str(few)
    assert judge(calibrate_camera(seen, BOARD, CAMERA.size)).is_good


def test_a_view_that_does_not_fit_is_left_out_and_named():
    random = np.random.default_rng(9)
    seen = views(random, tilted(random, 12, 30))
    bent = BoardView("bent", seen[3].corners + random.normal(0, 3, (54, 2)))
    found = calibrate_camera([*seen, bent], BOARD, CAMERA.size)
    assert found.left_out == ("bent",)
    assert found.rms < 0.2
    assert "bent fitted far worse" in str(judge(found))


def test_boards_in_one_corner_are_told_where_to_go_next():
    random = np.random.default_rng(10)
    seen = views(random, tilted(random, 15, 30))
    found = calibrate_camera(seen, BOARD, (1400, 1100))
    advice = str(judge(found))
    assert "cover only" in advice
    assert "at the" in advice


def test_views_of_another_board_are_refused():
    random = np.random.default_rng(11)
    with pytest.raises(InputError, match="54 corners but a 8x6 board has 48"):
        calibrate_camera(views(random, tilted(random, 5, 30)), Chessboard(8, 6, 0.03), CAMERA.size)


def test_camera_from_board_is_where_the_board_was():
    from .boards import poses

    random = np.random.default_rng(12)
    tilts = tilted(random, 16, 30)
    truth = list(poses(np.random.default_rng(13), tilts))
    seen = views(np.random.default_rng(13), tilts, noise=0.0)
    assert len(truth) == len(seen)
    found = calibrate_camera(seen, BOARD, CAMERA.size)
    # Corners go through OpenCV in single precision: 3e-5 px, far below a micrometre here, but
    # the fit of nine correlated parameters magnifies it.
    np.testing.assert_allclose(
        found.sightings[0].camera_from_board.translation, truth[0].translation, atol=2e-5
    )
