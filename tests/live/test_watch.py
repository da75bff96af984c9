"""What spoils a scan is told within seconds; a good dive is told nothing."""

import numpy as np
import pytest

from murkscan.live import PictureWatch
from murkscan.types.frame import Frame

NOISE = np.random.default_rng(0).normal(0, 2, (12, 240, 320))
GLOW = 12 + 40 * np.linspace(1, 0, 240)[:, None] * np.ones((240, 320))


def dive(levels, is_seen=True, seconds=5.0, watch=None, start=0.0):
    watch = watch or PictureWatch()
    for number in range(int(25 * seconds)):
        noisy = levels + NOISE[number % len(NOISE)]
        time = start + number / 25
        watch.look(Frame(np.clip(noisy, 0, 255).astype(np.uint8), number, time), is_seen)
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
