import numpy as np
import pytest

from murkscan.calibrate import laser_contrast

WHITE = np.array([145.0, 175.0, 215.0])
"""Paper as a real webcam shows it in daylight."""


def paper(width=200, height=60):
    return np.broadcast_to(WHITE, (height, width, 3)).copy()


def as_photo(levels):
    return np.clip(np.round(levels), 0, 255).astype(np.uint8)


@pytest.mark.parametrize(("wavelength", "channel"), [(450e-9, 2), (532e-9, 1), (650e-9, 0)])
def test_the_lasers_colour_stands_out_and_white_does_not(wavelength, channel):
    levels = paper() * np.linspace(0.2, 1.0, 200)[:, None]  # A shadow across the paper.
    levels[:, 100, channel] += 40
    contrast = laser_contrast(as_photo(levels), wavelength, white=WHITE)
    assert contrast[:, 100].min() >= 38
    # Three roundings to whole levels, of which two count 1.2 / 2 at most.
    assert np.delete(contrast, 100, axis=1).max() <= 2


def test_a_saturated_middle_is_closed():
    u = np.arange(200.0)
    levels = np.full((60, 200, 3), 40.0)
    stripe = np.exp(-((u - 100) ** 2) / (2 * 4.0**2))
    levels += stripe[:, None] * [600.0, 3000.0, 700.0]
    photo = as_photo(levels)
    assert (photo[30, 100] == 255).all()
    contrast = laser_contrast(photo, 532e-9, white=np.array([200.0, 200.0, 200.0]))
    assert contrast[30, 100] > 100
    assert contrast[30, 20] == 0


def test_a_large_white_glare_is_not_taken_for_the_laser():
    levels = paper()
    levels[10:50, 50:120] = 255
    contrast = laser_contrast(as_photo(levels), 532e-9, white=WHITE)
    assert contrast.max() <= 2


def test_a_grey_photo_gives_its_brightness_above_the_paper():
    levels = np.full((60, 200, 3), 120.0) + np.arange(200)[:, None] / 10
    levels[:, 99:102] += 60
    contrast = laser_contrast(as_photo(levels), 532e-9, white=np.array([120.0] * 3))
    assert contrast[5:-5, 100].min() >= 50
    assert contrast[5:-5, :90].max() <= 2
