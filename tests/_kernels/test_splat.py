"""Round bits of light are drawn whole, where they are, and cut off at the picture's edge."""

import numpy as np
import pytest

from murkscan._kernels.splat import splat_discs

SIDE = 64


def draw(u, v, sigma):
    image = np.zeros((SIDE, SIDE), np.float32)
    splat_discs(np.array([[u, v]]), np.array([sigma]), np.array([3.0]), image)
    return image


@pytest.mark.parametrize("sigma", [0.2, 1.0, 4.0])
def test_a_disc_has_its_light_its_place_and_its_width(sigma):
    image = draw(30.3, 25.6, sigma)
    rows, columns = np.mgrid[:SIDE, :SIDE]
    assert image.sum() == pytest.approx(3.0, rel=1e-5)
    if sigma >= 1:  # a narrower one's place is lost within its pixel
        assert (image * columns).sum() / 3 == pytest.approx(30.3, abs=1e-3)
        assert (image * rows).sum() / 3 == pytest.approx(25.6, abs=1e-3)
        width = (image * (columns - 30.3) ** 2).sum() / 3 - 1 / 12
        assert width == pytest.approx(sigma**2, rel=1e-3)


def test_half_of_a_disc_on_the_edge_is_drawn_and_none_that_is_nowhere():
    assert draw(-0.5, 30.0, 2.0).sum() == pytest.approx(1.5, rel=1e-5)
    assert draw(np.nan, 30.0, 2.0).sum() == 0
    assert draw(1e9, 30.0, 2.0).sum() == 0
