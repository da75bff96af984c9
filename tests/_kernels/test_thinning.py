"""The skeleton is OpenCV contrib's, pixel by pixel."""

import cv2
import numpy as np
import pytest

from murkscan._kernels.thinning import thin_zhang_suen


def _reference(binary):
    kind = cv2.ximgproc.THINNING_ZHANGSUEN
    return cv2.ximgproc.thinning(binary.astype(np.uint8) * 255, thinningType=kind) > 0


@pytest.mark.parametrize("seed", range(60))
def test_random_pictures_of_any_size_and_density(seed):
    rng = np.random.default_rng(seed)
    binary = rng.random(rng.integers(1, 60, 2)) < rng.random()
    np.testing.assert_array_equal(thin_zhang_suen(binary), _reference(binary))


@pytest.mark.parametrize("seed", range(20))
def test_blobs_that_touch_the_border(seed):
    smooth = cv2.GaussianBlur(np.random.default_rng(seed).random((80, 100)), (0, 0), 1 + seed / 4)
    binary = smooth > np.median(smooth)
    np.testing.assert_array_equal(thin_zhang_suen(binary), _reference(binary))


@pytest.mark.parametrize(
    "binary",
    [
        np.ones((40, 50), bool),
        np.zeros((5, 5), bool),
        np.ones((1, 9), bool),
        np.ones((3, 3), bool),
        np.indices((30, 30)).sum(axis=0) % 2 == 0,
        np.eye(20, dtype=bool) | np.eye(20, k=1, dtype=bool),
    ],
    ids=["full", "empty", "row", "nine", "checks", "stairs"],
)
def test_pictures_made_to_be_difficult(binary):
    np.testing.assert_array_equal(thin_zhang_suen(binary), _reference(binary))


def test_a_thick_line_becomes_one_pixel_thin_and_its_picture_is_left_alone():
    binary = np.zeros((30, 60), bool)
    binary[10:17, 5:55] = True
    before = binary.copy()
    assert thin_zhang_suen(binary).sum(axis=0).max() == 1
    np.testing.assert_array_equal(binary, before)


def test_the_paper_s_first_corner_case_by_hand():
    """A 3 × 3 block: the first pass takes its south-east border and north-west corner."""
    binary = np.zeros((5, 5), bool)
    binary[1:4, 1:4] = True
    np.testing.assert_array_equal(np.argwhere(thin_zhang_suen(binary)), [[2, 2]])
