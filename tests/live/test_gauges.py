"""What gauges show, against what is known."""

import math

import numpy as np
import pytest

from murkscan.live import (
    Look,
    RecentLooks,
    draw_picture,
    find_calibrated_range,
    find_working_range,
    gauge_disk,
    gauge_speed,
    gauge_stand_off,
    gauge_stripe,
    gauge_water,
    speed_of,
    warn_of_disk,
)
from murkscan.types.background import Attenuation
from murkscan.types.frame import Frame
from murkscan.types.trajectory import Trajectory

from ..scenes import air_rig


def look(depth=0.5, signal=100.0, points=90, time=0.0):
    return Look(time, points, 100, depth, depth, signal)


@pytest.mark.parametrize(
    ("depth", "state"), [(0.31, "too near"), (0.5, "good"), (0.93, "too far"), (2.0, "too far")]
)
def test_the_stand_off_is_judged_by_the_working_range(depth, state):
    gauge = gauge_stand_off([look(depth)] * 5, (0.3, 1.0), None)
    assert (gauge.state, gauge.value) == (state, depth)


def test_murky_water_shortens_the_working_range():
    assert gauge_stand_off([look(0.7)], (0.3, 2.0), 0.6).state == "too far"
    assert gauge_stand_off([look(0.5)], (0.3, 2.0), 0.8).far == 0.8
    assert gauge_stand_off([], (0.3, 2.0), None).state == "unknown"


def test_the_working_range_is_where_the_sheet_crosses_the_picture():
    near, far = find_working_range(air_rig(baseline=0.25, distance=0.5), 0)
    assert gauge_stand_off([look(0.84)], (near, far), None).state == "good"
    # Equation (4) at the lower and upper rows: Z = b f / (f cot θ − y), without an end above.
    assert near == pytest.approx(0.25 * 554 / (554 * 0.5 + 287.5), rel=1e-6)
    assert far == pytest.approx(20.0)


def test_the_calibrated_range_is_that_of_the_laser_s_boards():
    def errors(laser, *depths):
        what = f"a point of laser {laser}"
        return [{"what": what, "distance_mm": d, "sigma_mm": 0.1} for d in depths]

    record = {
        "camera": {"errors": [{"what": "a flat shape", "distance_mm": 100, "sigma_mm": 1}]},
        "laser": {"0": {"errors": errors(0, 400, 600.0, 900)}, "1": {"errors": errors(1, 500)}},
    }
    assert find_calibrated_range(record, 0) == (0.4, 0.9)
    assert find_calibrated_range(record, 1) is None
    assert find_calibrated_range({}, 0) is None


def test_speed_is_judged_by_what_the_spacing_needs():
    assert gauge_speed(0.1, 25.0, 5e-3).state == "good"
    assert gauge_speed(-0.2, 25.0, 5e-3).state == "too fast"
    assert gauge_speed(0.1, 25.0, 5e-3).highest == pytest.approx(125.0)
    assert gauge_speed(None, 25.0, 5e-3).state == "unknown"
    way = Trajectory(
        np.arange(3.0), np.array([[0, 0, 0], [0.1, 0, 0], [0.2, 0, 0.0]]), np.eye(4)[[0, 0, 0]]
    )
    assert speed_of(way) == pytest.approx(0.1)


def test_a_stripe_is_good_weak_or_lost():
    assert gauge_stripe([look(signal=100.0)], 2.0).state == "good"
    assert gauge_stripe([look(signal=15.0)], 2.0).state == "weak"
    assert gauge_stripe([look(points=1)], 2.0).state == "lost"
    assert gauge_stripe([], 2.0).state == "unknown"


@pytest.mark.parametrize("murk", [0.5, 3.0])
def test_the_reach_is_where_this_stripe_fades_into_the_noise(murk):
    gauge = gauge_water(Attenuation(murk, murk / 2, 2 * murk), [look(0.5, 120.0)], 2.0)
    left = 120.0 * math.exp(-2 * murk * (gauge.reach - 0.5)) * 0.5 / gauge.reach
    assert left == pytest.approx(5 * 2.0, rel=1e-6)
    assert gauge.attenuation == murk
    assert gauge_water(None, [look()], 2.0).reach is None


def test_the_disk_is_low_before_it_is_full():
    assert gauge_disk(int(50e9), int(1e6), 1.0).state == "good"
    assert gauge_disk(int(50e9), int(100e6), 1.0).state == "low"
    assert gauge_disk(int(1e9), 0, 0.0).state == "low"
    assert gauge_disk(int(1e8), 0, 0.0).state == "full"
    assert gauge_disk(int(50e9), int(1e6), 1.0).time_left == pytest.approx(50_000)


def test_a_disk_that_is_nearly_full_is_told_in_one_sentence():
    assert warn_of_disk(gauge_disk(int(50e9), int(1e6), 1.0)) == ()
    (low,) = warn_of_disk(gauge_disk(int(1.2e9), int(5e6), 1.0))
    assert "nearly full: 1.2 GB left, enough for 4 min" in low
    (full,) = warn_of_disk(gauge_disk(int(5e7), int(5e6), 1.0))
    assert "full (50 MB left)" in full


def test_recent_looks_forget_what_is_old_and_count_what_was_dropped():
    recent = RecentLooks()
    for number in range(0, 500, 2):  # every second frame of 50 a second was dropped
        recent.add(look(time=number / 50), number, 0.1 + 0.1 * (number >= 490))
    assert recent.looks[0].time == pytest.approx(recent.looks[-1].time - 2.0, abs=0.041)
    assert recent.rate == pytest.approx(50.0)
    assert recent.latency == pytest.approx(0.1)


def test_pictures_are_drawn_small_and_fields_at_their_full_height():
    field = Frame(np.full((288, 720), 40, np.uint8), 0, 0.0, 1, 2)
    drawn = draw_picture(field, np.array([[100.0, 301.0]]))
    assert drawn.shape == (576, 720, 3)
    assert drawn[301, 100].tolist() != [40, 40, 40]
    large = Frame((np.ones((1080, 1920)) * 4095).astype(np.uint16), 0, 0.0)
    assert draw_picture(large).shape == (540, 960, 3)
    assert draw_picture(large).min() == 255
