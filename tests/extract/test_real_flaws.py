"""What real pictures have beside the stripe: dirt, rims, rows with noise, bands of white."""

import numpy as np
import pytest

from murkscan.extract import Murk
from murkscan.types.camera import Camera
from murkscan.types.frame import Frame
from murkscan.types.laser import Laser
from murkscan.types.rig import Rig

HEIGHT, LENGTH = 160, 240
"""Pixels across the stripe and along it."""
RIG = Rig(
    Camera((LENGTH, HEIGHT), (600.0, 600.0), (120.0, 80.0)),
    (Laser.from_baseline_angle(0.2, 1.1, "y"),),
)
LINES = np.arange(LENGTH)
ROWS = np.arange(HEIGHT)[:, None]


def _line(centres, peak, *, width=1.3):
    return peak * np.exp(-0.5 * ((ROWS - centres) / width) ** 2)


def _film(light, *, rows=0.0, seed=0):
    """Keep light as a sensor does, with shot and read noise, and noise that a row has in common."""
    rng = np.random.default_rng(seed)
    frames = []
    for index, one in enumerate(light):
        noise = np.sqrt(0.04 + 0.03 * one) * rng.standard_normal(one.shape)
        noise += rows * rng.standard_normal((HEIGHT, 1))
        image = np.clip(np.rint(one + noise), 0, 255).astype(np.uint8)
        frames.append(Frame(image, index, index / 25))
    return frames


def _extract(frames):
    murk = Murk()
    return list(murk.extract(frames, RIG, murk.learn(frames, RIG)))


def _dirt(rng):
    """Draw hot pixels, and a ghost that is brighter than the stripe."""
    picture = _line(40.0 + 0.02 * LINES, 60.0)
    hot = rng.random(picture.shape) < 0.01
    return picture + np.where(hot, rng.uniform(40, 200, picture.shape), 0.0)


def _errors(stripes, truth):
    return np.concatenate(
        [s.pixels[:, 1] - truth(i)[s.pixels[:, 0].astype(int)] for i, s in enumerate(stripes)]
    )


def test_a_ghost_and_hot_pixels_are_no_stripe_where_the_stripe_moves():
    dirt = _dirt(np.random.default_rng(1))
    stripes = _extract(
        _film([8.0 + dirt + _line(80.0 + 0.8 * i + 0 * LINES, 40.0) for i in range(24)])
    )
    off = np.abs(_errors(stripes, lambda i: 80.0 + 0.8 * i + 0 * LINES))
    assert len(off) > 0.97 * 24 * LENGTH
    assert np.mean(off < 1.5) > 0.985


def test_a_still_stripe_that_flickers_is_found_beside_a_ghost_that_does_not():
    """Paint that passes by changes a stripe's height by a third; a ghost keeps its own."""
    rng = np.random.default_rng(2)
    dirt, paint = _dirt(rng), 1.0 + 0.35 * rng.standard_normal((24, LENGTH // 12))
    heights = np.repeat(np.clip(paint, 0.3, None), 12, axis=1)
    stripes = _extract(_film([8.0 + dirt + h * _line(100.0 + 0 * LINES, 40.0) for h in heights]))
    off = np.abs(_errors(stripes, lambda _: 100.0 + 0 * LINES))
    assert np.sum(off < 1.5) > 0.95 * 24 * LENGTH
    assert np.mean(off < 1.5) > 0.98


def test_with_the_laser_off_dirt_is_no_stripe():
    dirt = 8.0 + _dirt(np.random.default_rng(3))
    assert sum(len(stripe) for stripe in _extract(_film([dirt] * 24))) == 0


def test_an_even_stripe_that_stands_still_in_a_clean_picture_is_found():
    stripes = _extract(_film([8.0 + _line(100.0 + 0 * LINES, 40.0)] * 24))
    assert sum(len(stripe) for stripe in stripes) == 24 * LENGTH


@pytest.mark.parametrize("many", [1, 12])
def test_a_bright_rim_of_the_picture_is_no_stripe(many):
    light = [8.0 + _line(80.0 + 0.5 * i + 0 * LINES, 40.0) for i in range(many)]
    for one in light:
        one[[0, -1]] = 150.0
        one[:, [0, -1]] = 150.0
    stripes = _extract(_film(light))
    off = np.abs(_errors(stripes, lambda i: 80.0 + 0.5 * i + 0 * LINES))
    assert len(off) == many * (LENGTH - 2)
    assert off.max() < 1.5


def test_noise_that_rows_have_in_common_is_no_stripe_and_hides_none():
    assert sum(len(s) for s in _extract(_film([8.0 + 0 * ROWS + 0.0 * LINES] * 12, rows=1.0))) == 0
    hull = [90.0 + 12.0 * np.sin(LINES / 40.0) + 0.5 * i for i in range(12)]
    stripes = _extract(_film([8.0 + _line(one, 12.0) for one in hull], rows=1.0))
    off = np.abs(_errors(stripes, lambda i: hull[i]))
    assert len(off) > 0.97 * 12 * LENGTH
    assert np.mean(off < 1.5) > 0.99


@pytest.mark.parametrize("width", [4.0, 8.0])
def test_a_band_of_white_is_found_by_both_its_edges(width):
    """The peak is four times what the sensor holds; light on one side adds a slope."""
    truth = [80.0 + 0.05 * LINES + 0.31 * i for i in range(12)]
    light = [8.0 + 0.05 * ROWS + _line(one, 1000.0, width=width) for one in truth]
    stripes = _extract(_film([np.minimum(one, 255.0) for one in light]))
    off = _errors(stripes, lambda i: truth[i])
    assert len(off) > 0.97 * 12 * LENGTH
    # Both flanks are one in a thousand steeper than what the slope adds.
    assert abs(off.mean()) < 0.05
    assert np.abs(off).max() < 0.5
    assert all((stripe.signal <= 255).all() for stripe in stripes)
