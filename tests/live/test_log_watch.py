"""A log whose clock is another one than the pictures' is told, and one that fits is not."""

import math

import pytest

from murkscan.live import LogWatch


def watch(known, *, is_replayed=False, seconds=4):
    """Look once a second; `known` gives from when and until when poses are known."""
    watched = LogWatch(is_replayed=is_replayed)
    for second in range(10, 10 + seconds):
        watched.look(float(second), *known(second))
    return watched.warnings()


def test_a_log_that_fits_is_told_nothing():
    assert watch(lambda now: (0.0, now - 1.0)) == ()
    assert watch(lambda now: (-math.inf, math.inf)) == ()


@pytest.mark.parametrize(
    ("known", "said"),
    [
        (lambda now: (-30.0, now - 30.0), "30 s behind"),
        (lambda now: (now + 3600.0, now + 3601.0), "60 min ahead"),
        (lambda now: (0.0, now + 8.0), "8 s ahead"),
    ],
)
def test_a_clock_that_is_off_is_told_by_how_much(known, said):
    (warning,) = watch(known)
    assert said in warning
    assert "clock" in warning


def test_a_log_of_a_replayed_dive_may_end_after_it():
    assert watch(lambda now: (0.0, 600.0), is_replayed=True) == ()
    assert "ahead" in watch(lambda now: (300.0, 600.0), is_replayed=True)[0]


def test_a_log_without_poses_is_told():
    assert "no pose yet" in watch(lambda now: (math.inf, -math.inf))[0]


def test_a_moment_is_no_warning():
    assert watch(lambda now: (0.0, now - 30.0), seconds=1) == ()
