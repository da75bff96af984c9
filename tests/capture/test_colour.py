import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from murkscan.capture import LaserColour
from murkscan.capture.colour import EachColour

wavelengths = st.floats(380e-9, 1100e-9)


@given(wavelengths, st.sampled_from([np.uint8, np.uint16]))
def test_grey_stays_grey_and_white_stays_white(wavelength, depth):
    top = np.iinfo(depth).max
    levels = np.array([[0, 1, 77, 128, top - 1, top]], depth)
    grey = LaserColour.mean(wavelength).grey(np.dstack([levels] * 3))
    assert grey.dtype == depth
    # Single precision holds 16 bits with room; the sum of the weights is 1 to its last bit.
    np.testing.assert_array_equal(grey, levels)


@given(wavelengths)
def test_weights_are_a_mean(wavelength):
    weights = LaserColour.mean(wavelength).weights
    assert sum(weights) == pytest.approx(1)
    assert min(weights) > 0


@pytest.mark.parametrize(("wavelength", "channel"), [(450e-9, 2), (532e-9, 1), (650e-9, 0)])
def test_the_lasers_own_channel_weighs_most(wavelength, channel):
    assert np.argmax(LaserColour.mean(wavelength).weights) == channel


def test_levels_are_rounded_not_cut():
    image = np.zeros((1, 3, 3), np.uint8)
    image[0, :, 1] = (1, 2, 3)
    colour = LaserColour.mean(532e-9)
    green = colour.weights[1]
    np.testing.assert_array_equal(colour.grey(image)[0], np.rint(green * np.array([1, 2, 3])))
    assert 0.5 < green < 1  # so that cutting would give 0 1 2 at most


def test_a_saturated_line_keeps_its_middle():
    """Where red is full over a width, the other channels still make one peak of it."""
    across = np.arange(-20, 21)
    light = 900 * np.exp(-(across**2) / 32)
    line = np.minimum(np.stack([light, 0.12 * light, 0.08 * light], axis=-1), 255)
    grey = LaserColour.mean(650e-9).grey(np.rint(line)[None].astype(np.uint8))[0].astype(int)
    assert (line[:, 0] == 255).sum() > 10
    assert np.flatnonzero(grey == grey.max()).tolist() == pytest.approx([0 + 20], abs=2)


def test_a_contrast_takes_other_light_off_and_leaves_noise_both_sides():
    contrast = LaserColour(532e-9, (-0.5, 1.0, -0.5), pedestal=0.02)
    picture = np.zeros((1, 4, 3), np.uint8)
    picture[0] = [[0, 0, 0], [200, 200, 200], [40, 40, 48], [60, 160, 60]]
    # The pedestal of 5.1 levels stays where light is grey; 4 less light of the laser is 1.1.
    assert contrast.grey(picture)[0].tolist() == [5, 5, 1, 105]


def test_a_white_core_is_closed_between_its_coloured_flanks_and_white_paper_is_not():
    contrast = LaserColour(532e-9, (-0.5, 1.0, -0.5), pedestal=0.02)
    picture = np.full((60, 120, 3), 30, np.uint8)
    picture[:, 20:32] = (60, 160, 60)
    picture[:, 24:28] = 255
    picture[:, 60:110] = 255
    grey = contrast.grey(picture)
    assert (grey[:, 20:32] == 105).all()
    assert (grey[:, 40:] == 5).all()


def test_the_coloured_fringe_of_a_white_area_is_no_line():
    """The lens shows green a little farther up than red and blue: its light looks green there."""
    contrast = LaserColour(532e-9, (-0.5, 1.0, -0.5), pedestal=0.02)
    picture = np.full((80, 80, 3), 30, np.uint8)
    picture[20:60, 20:60] = 255
    picture[19, 20:60] = (150, 220, 150)
    picture[60, 20:60] = (220, 150, 220)
    grey = contrast.grey(picture)
    assert grey[:, 21:59].max() == 5


def test_each_colour_stands_beside_the_others():
    image = np.arange(24, dtype=np.uint8).reshape(2, 4, 3)
    np.testing.assert_array_equal(EachColour().grey(image).reshape(2, 4, 3), image)
    grey = EachColour().grey(image[..., 1]).reshape(2, 4, 3)
    np.testing.assert_array_equal(grey, np.dstack([image[..., 1]] * 3))
