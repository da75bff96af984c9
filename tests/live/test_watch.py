"""What spoils a scan is told within seconds; a good dive is told nothing."""

import numpy as np
import pytest

from murkscan.live import Look, PictureWatch, measure_stripe_width
from murkscan.types.frame import Frame

NOISE = np.random.default_rng(0).normal(0, 2, (12, 240, 320))
GLOW = 12 + 40 * np.linspace(1, 0, 240)[:, None] * np.ones((240, 320))


def dive(levels, is_seen=True, seconds=5.0, watch=None, start=0.0, width=3.0, depth=0.8):
    watch = watch or PictureWatch()
    for number in range(int(25 * seconds)):
        noisy = levels + NOISE[number % len(NOISE)]
        time = start + number / 25
        look = Look(time, 300 if is_seen else 0, 320, depth, depth, 50.0, width)
        watch.look(Frame(np.clip(noisy, 0, 255).astype(np.uint8), number, time), look)
    return watch


def test_a_good_dive_is_told_nothing():
    watch = dive(GLOW)
    stripe = GLOW.copy()
    for part in range(4):  # the surface comes nearer, hides water, and is bright
        stripe[200 - 30 * part :, :] = 14
        stripe[198 - 30 * part : 202 - 30 * part] = 250
        watch = dive(stripe, seconds=1.0, watch=watch, start=5.0 + part)
    assert watch.warnings() == ()


@pytest.mark.parametrize("factor", [0.6, 1.6])
def test_an_exposure_that_moves_is_told(factor):
    watch = dive(12 + factor * (GLOW - 12), watch=dive(GLOW), start=5.0, seconds=4.0)
    (said,) = watch.warnings()
    assert "exposure" in said


def test_a_lamp_is_told_and_forgotten_when_it_is_off():
    watch = dive(GLOW + 90, watch=dive(GLOW), start=5.0)
    assert any("lamp is on" in said for said in watch.warnings())
    assert dive(GLOW, watch=watch, start=10.0).warnings() == ()


def test_a_lost_stripe_is_told_after_a_second_and_not_before():
    watch = dive(GLOW)
    assert dive(GLOW, is_seen=False, seconds=0.6, watch=watch, start=5.0).warnings() == ()
    watch = dive(GLOW, is_seen=False, seconds=2.0, watch=watch, start=5.6)
    (said,) = watch.warnings()
    assert "stripe is lost" in said
    assert dive(GLOW, seconds=0.2, watch=watch, start=8.0).warnings() == ()


def test_a_laser_that_was_never_on_is_asked_for():
    (said,) = dive(GLOW, is_seen=False).warnings()
    assert "No stripe has been seen yet" in said


def test_a_stripe_that_becomes_wide_is_a_fogged_window():
    fogged = dive(GLOW, width=9.0, seconds=3.0, watch=dive(GLOW), start=5.0)
    (said,) = fogged.warnings()
    assert "window is fogged" in said
    assert dive(GLOW, seconds=3.0, watch=fogged, start=8.0).warnings() == ()


def test_a_surface_that_comes_nearer_makes_a_wide_stripe_and_no_fog():
    assert dive(GLOW, width=7.0, depth=0.3, watch=dive(GLOW), start=5.0).warnings() == ()


@pytest.mark.parametrize("axis", ["x", "y"])
@pytest.mark.parametrize("row_step", [1, 2])
def test_the_width_of_a_stripe_is_that_at_half_of_its_height(axis, row_step):
    across = np.arange(240) if axis == "x" else row_step * np.arange(240.0)
    sigma, middle = 4.0, 101.0
    level = 10 + 100 * np.exp(-0.5 * ((across - middle) / sigma) ** 2)
    image = np.tile(level, (240, 1)) if axis == "x" else np.tile(level, (240, 1)).T
    frame = Frame(image.astype(np.uint8), 0, 0.0, 0, row_step)
    along = np.arange(30.0, 200)
    pixels = np.stack([np.full(170, middle), along], axis=1)
    pixels = pixels if axis == "x" else pixels[:, ::-1]
    # Full width at half of the height of a Gaussian, to the pixel or the field's two.
    width = measure_stripe_width(frame, pixels, axis)
    assert width == pytest.approx(2.355 * sigma, abs=1.0 if axis == "x" else row_step)


def test_a_stripe_that_is_slanted_or_overexposed_is_no_wider():
    u, v = np.meshgrid(np.arange(320.0), np.arange(240.0))
    slanted = (u - v - 40) / np.sqrt(2)
    image = 10 + 100 * np.exp(-0.5 * (slanted / 3.0) ** 2)
    image[:100] = np.minimum(10 + 2000 * np.exp(-0.5 * (slanted[:100] / 3.0) ** 2), 255)
    rows = np.arange(30.0, 200)
    frame = Frame(image.astype(np.uint8), 0, 0.0)
    width = measure_stripe_width(frame, np.stack([rows + 40, rows], axis=1), "x")
    assert width == pytest.approx(2.355 * 3.0, abs=1.0)


def test_a_frame_without_a_stripe_has_no_width():
    frame = Frame(np.zeros((240, 320), np.uint8), 0, 0.0)
    assert np.isnan(measure_stripe_width(frame, np.zeros((0, 2)), "y"))
