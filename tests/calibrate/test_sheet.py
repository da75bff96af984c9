import numpy as np
import pytest

from murkscan.calibrate import StripeOnBoard, fit_sheet
from murkscan.errors import Degenerate, NotEnoughData
from murkscan.optics import project
from murkscan.types.plane import Plane
from murkscan.types.pose import Pose

from .boards import CAMERA, rotation

SHEET = Plane.through(np.array([-0.18, 0.0, 0.0]), np.array([0.9, -0.14, 0.4]))


def stripes(random, depths, noise=0.2, outliers=0, most=25.0, pose_noise=0.0):
    """Cross boards at depths [m] with the sheet, and look at the line with noise [px]."""
    for number, depth in enumerate(depths):
        turned = rotation(*random.uniform(-most, most, 3))
        board = Plane.through(np.array([0.0, 0.0, depth]), turned[:, 2])
        along = np.cross(SHEET.normal, board.normal)
        # One point of both planes, nearest the board's middle.
        system = np.stack([SHEET.normal, board.normal, along])
        start = np.linalg.solve(system, [-SHEET.distance, -board.distance, depth * along[2]])
        steps = np.linspace(-0.1, 0.1, 80)[:, None] / np.linalg.norm(along)
        pixels = project(CAMERA, start + steps * along) + random.normal(0, noise, (80, 2))
        pixels[:outliers] += random.uniform(20, 60, (outliers, 2))
        seen = board.normal * random.normal(0, pose_noise) + [0.0, 0.0, depth]
        yield StripeOnBoard(f"photo{number}", pixels, Pose(turned, seen))


def angle_to_truth(found):
    return np.linalg.norm(np.cross(found.sheet.normal, SHEET.normal))


@pytest.mark.parametrize("outliers", [0, 16])
def test_the_sheet_is_found_within_its_stated_deviation(outliers):
    random = np.random.default_rng(1)
    depths = np.linspace(0.4, 1.0, 20)
    found = fit_sheet(list(stripes(random, depths, outliers=outliers)), CAMERA)
    assert angle_to_truth(found) < 3 * found.angle_sigma < np.radians(0.15)
    assert found.num_points - found.num_inliers == pytest.approx(20 * outliers, abs=20)


def test_the_stated_deviation_holds_when_whole_boards_are_off():
    """Points of a photo share its board's error, so their number must not flatter."""
    pulls = []
    for seed in range(30):
        random = np.random.default_rng(seed)
        seen = list(stripes(random, np.linspace(0.4, 1.0, 15), pose_noise=1e-3))
        found = fit_sheet(seen, CAMERA)
        pulls.append(angle_to_truth(found) / found.angle_sigma)
    # Two directions of tilt with one stated deviation, that of the worse: an RMS of 0.7 to 1.4;
    # 30 draws scatter by an eighth.
    assert 0.5 < np.sqrt(np.mean(np.square(pulls))) < 1.6


def test_the_equivalent_baseline_and_angle_are_those_of_the_sheet():
    found = fit_sheet(list(stripes(np.random.default_rng(2), [0.4, 0.6, 0.8, 1.0])), CAMERA)
    assert found.laser.axis == "x"
    baseline, angle = found.laser.as_baseline_angle()
    # b and θ as the paper has them: the laser at X = 0.18 is on the far side, so b < 0, θ > 90°.
    true_baseline = SHEET.distance / SHEET.normal[0]
    assert baseline == pytest.approx(true_baseline, abs=2e-3)
    assert angle == pytest.approx(np.arctan2(0.9, -0.4), abs=np.radians(0.3))


def test_one_photo_is_refused():
    seen = list(stripes(np.random.default_rng(3), [0.5]))
    with pytest.raises(NotEnoughData, match="found it in 1 of 1"):
        fit_sheet(seen, CAMERA)


def test_boards_in_one_place_are_refused_with_reason_and_remedy():
    seen = list(stripes(np.random.default_rng(4), [0.5, 0.501, 0.502, 0.5, 0.501] * 3, most=1.0))
    with pytest.raises(Degenerate, match="nearly on one line") as refusal:
        fit_sheet(seen, CAMERA)
    assert "nearer and farther" in str(refusal.value)


def test_the_reach_is_that_of_the_boards():
    seen = list(
        stripes(np.random.default_rng(5), np.linspace(0.5, 0.545, 16), most=1.0, noise=0.05)
    )
    # The stripe lies up to half a board, tilted by a degree, in front of its middle.
    assert fit_sheet(seen, CAMERA).reach == pytest.approx((0.5, 0.545), abs=3e-3)
