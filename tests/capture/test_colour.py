import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from murkscan.capture import grey_from_colour
from murkscan.capture.colour import channel_weights

wavelengths = st.floats(380e-9, 1100e-9)


@given(wavelengths, st.sampled_from([np.uint8, np.uint16]))
def test_grey_stays_grey_and_white_stays_white(wavelength, depth):
    top = np.iinfo(depth).max
    levels = np.array([[0, 1, 77, 128, top - 1, top]], depth)
    grey = grey_from_colour(np.dstack([levels] * 3), wavelength)
    assert grey.dtype == depth
    # Single precision holds 16 bits with room; the sum of the weights is 1 to its last bit.
    np.testing.assert_array_equal(grey, levels)


@given(wavelengths)
def test_weights_are_a_mean(wavelength):
    weights = channel_weights(wavelength)
    assert weights.sum() == pytest.approx(1)
    assert (weights > 0).all()


@pytest.mark.parametrize(("wavelength", "channel"), [(450e-9, 2), (532e-9, 1), (650e-9, 0)])
def test_the_lasers_own_channel_weighs_most(wavelength, channel):
    assert channel_weights(wavelength).argmax() == channel


def test_levels_are_rounded_not_cut():
    image = np.zeros((1, 3, 3), np.uint8)
    image[0, :, 1] = (1, 2, 3)
    green = channel_weights(532e-9)[1]
    np.testing.assert_array_equal(
        grey_from_colour(image, 532e-9)[0], np.rint(green * np.array([1, 2, 3]))
    )
    assert 0.5 < green < 1  # so that cutting would give 0 1 2 at most


def test_a_saturated_line_keeps_its_middle():
    """Where red is full over a width, the other channels still make one peak of it."""
    across = np.arange(-20, 21)
    light = 900 * np.exp(-(across**2) / 32)
    line = np.minimum(np.stack([light, 0.12 * light, 0.08 * light], axis=-1), 255)
    grey = grey_from_colour(np.rint(line)[None].astype(np.uint8), 650e-9)[0].astype(int)
    assert (line[:, 0] == 255).sum() > 10
    assert np.flatnonzero(grey == grey.max()).tolist() == pytest.approx([0 + 20], abs=2)
