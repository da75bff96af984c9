"""What photos that are still being taken are told to be worth, and which are missing."""

import numpy as np
import pytest

from murkscan.calibrate.so_far import judge_so_far, untilted

from .boards import BOARD, CAMERA, rotation, views

EDGES = {"left": (-1, 0), "right": (1, 0), "upper": (0, -1), "lower": (0, 1)}


@pytest.mark.parametrize("tilt", [(25, 0), (-25, 0), (0, 25), (0, -25)])
def test_the_edge_that_is_nearer_is_the_one_not_asked_for(tilt):
    turned = rotation(*tilt, 10)
    corners = np.array([[x, y, 0.0] for x, y in EDGES.values()])
    nearest = list(EDGES)[int((turned @ corners.T)[2].argmin())]
    missing = untilted(turned[:, 2][None])
    assert nearest not in missing
    assert len(missing) == 3


def test_what_is_judged_is_the_calibration_and_the_rest_is_asked_for():
    random = np.random.default_rng(1)
    tilts = [(x, y) for x in (-30, 0, 30) for y in (25, 30, 35)]
    told = judge_so_far(views(random, tilts), BOARD, CAMERA.size)
    assert told.num_found == 9
    assert "9 photos are few" in told.verdict
    assert not told.is_good
    # All boards are turned about y to one side.
    assert sum(text.startswith("with its") for text in told.missing) == 1
    # Corners of 0.1 px in nine views; jackknife figures of such sets lie near 0.2 %.
    assert 2e-4 < told.focal_sigma < 1e-2
    assert told.coverage.cells.mean() == pytest.approx(told.coverage.share)


def test_too_few_photos_are_told_in_the_calibration_s_own_words():
    random = np.random.default_rng(2)
    told = judge_so_far(views(random, [(0, 20), (20, 0)]), BOARD, CAMERA.size)
    assert told.focal_sigma is None
    assert "Need at least 4 views" in told.verdict
