"""Samples, distributions, speed, belief and calibration: numbers of the report that are known."""

from datetime import date

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from murkscan.report import Belief, Histogram, judge_speed
from murkscan.report.calibrated import read_steps
from murkscan.report.even_sample import EvenSample
from murkscan.types.frame_times import FrameTimes
from murkscan.types.trajectory import Trajectory


@given(st.lists(st.integers(0, 60), max_size=20), st.integers(1, 40))
def test_a_sample_is_even_however_the_numbers_come(lengths, most):
    sample, first = EvenSample(most), 0
    for length in lengths:
        sample.add(np.arange(first, first + length))
        first += length
    kept = sample.values()
    assert len(kept) <= most
    if first:
        strides = set(np.diff(kept).tolist())
        assert kept[0] == 0
        assert len(strides) <= 1
        # Not more is thrown away than has to be: twice as many would be too many.
        assert 2 * len(kept) + 1 >= min(first, most)


def test_a_histogram_counts_every_number_once():
    values = np.random.default_rng(0).normal(5.0, 1.0, 10_000)
    for histogram in (Histogram.from_values(values), Histogram.from_ratios(np.exp(values))):
        total = histogram.shares.sum() + histogram.below + histogram.above
        assert total == pytest.approx(1.0)
        assert np.all(np.diff(histogram.edges) > 0)
        # The bins lie between the quantiles 0.002 and 0.998.
        assert histogram.below == pytest.approx(0.002, abs=2e-4)


@pytest.mark.parametrize("value", [0.0, 3.0, -2.0])
def test_numbers_that_are_all_the_same_have_a_histogram(value):
    assert Histogram.from_values(np.full(9, value)).shares.sum() == pytest.approx(1.0)


def test_without_numbers_there_are_no_bins():
    assert len(Histogram.from_ratios(np.array([0.0, -1.0, np.nan])).edges) == 0


def test_points_are_counted_by_their_posterior():
    posterior = np.array([0.4, 0.5, 0.69, 0.7, 0.95, 0.99, 1.0], np.float32)
    belief = Belief.from_posterior(posterior)
    assert belief.counts == (1, 2, 1, 1, 2)
    assert sum((belief + belief).shares) == pytest.approx(1.0)
    assert not Belief.from_posterior(np.ones(3, np.float32)).is_told


def _judge(*, lost=(), is_timed=True, wanted=0.001):
    number = np.array([n for n in range(100) if n not in lost])
    times = np.arange(100) * 0.02
    positions = np.stack([0 * times, 0.1 * times, 0 * times], axis=1)
    trajectory = Trajectory(times, positions, np.tile([1.0, 0, 0, 0], (100, 1)))
    frames = FrameTimes(number.astype(np.uint32), number * 0.02)
    return judge_speed(frames, trajectory, is_timed=is_timed, wanted=wanted)


@pytest.mark.parametrize("lost", [(), (3, 4, 5, 50)])
def test_the_highest_speed_is_the_wanted_spacing_in_each_frame(lost):
    speed = _judge(lost=lost)
    assert speed.rate == pytest.approx(50)
    assert speed.shown.median == pytest.approx(0.1)
    assert speed.step.median == pytest.approx(0.002)
    assert speed.highest == pytest.approx(0.05)
    assert speed.needed_rate == pytest.approx(100)


def test_without_times_there_is_a_step_but_no_speed():
    speed = _judge(is_timed=False)
    assert speed.step.median == pytest.approx(0.002)
    assert speed.rate is speed.highest is speed.shown.median is None


def test_a_calibration_is_read_step_by_step_with_its_age():
    record = {
        "camera": {
            "date": "2026-05-01",
            "views": 20,
            "photos": 22,
            "rms_px": 0.2,
            "verdict": "Good: x",
        },
        "laser": {"0": {"date": date(2026, 5, 3), "verdict": "Usable, but: add photos."}},
        "covariance": {"parameters": []},
        "odd": 3,
    }
    camera, laser = read_steps(record, recorded=date(2026, 5, 11))
    assert (camera.name, camera.age_days, camera.is_good) == ("camera", 10, True)
    assert camera.evidence == "20 of 22 photos, corners off by 0.2 px (RMS)"
    assert (laser.name, laser.age_days, laser.is_good) == ("laser 0", 8, False)
    assert read_steps(record, recorded=None)[0].age_days is None
    assert read_steps({}, recorded=None) == []
