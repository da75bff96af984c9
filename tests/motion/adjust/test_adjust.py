"""Passes over a bumpy plate: two sheets find the way again, and what nothing shows stays."""

import numpy as np
import pytest

from murkscan.errors import InputError
from murkscan.motion.adjust import AdjustSettings, Pass, adjust_passes
from murkscan.motion.adjust.path import Path
from murkscan.motion.adjust.spline import Knots
from murkscan.motion.adjust.ties import Ties, linearise
from murkscan.types.navigation import Navigation, NavigationAccuracy, Readings

pytestmark = pytest.mark.without_types

DURATION, RATE, SPEED, STAND_OFF = 6.0, 20.0, 0.1, 0.6
QUICK = AdjustSettings(fine_rounds=5)


def bumps(x, y, height):
    return height * (
        np.sin(x / 0.011 + 2 * np.sin(y / 0.031)) + np.sin(y / 0.013 + 2 * np.sin(x / 0.027))
    )


def swing(times):
    """Give how far the vehicle is ahead of its log: 6 mm, with a period of 3 s."""
    return 6e-3 * np.sin(2 * np.pi * times / 3)


def scan(height, *, lasers=2, speed_sigma=0.01):
    times = np.arange(0, DURATION, 1 / RATE)
    ahead = SPEED * times + swing(times)
    across = np.linspace(-0.15, 0.15, 80)
    points, profile, line, laser = [], [], [], []
    for number, gap in enumerate((0.0, 0.08)[:lasers]):
        for i, at in enumerate(ahead):
            x = np.full(80, at + gap)
            z = STAND_OFF - bumps(x, across, height)
            points.append(np.stack([x - at, across, z], axis=1))
            profile.append(np.full(80, i))
            line.append(np.arange(80))
            laser.append(np.full(80, number, np.uint8))
    log = Navigation(
        NavigationAccuracy(
            velocity_noise=speed_sigma, attitude_noise=1e-3, depth_noise=1e-3, position_noise=1e-3
        ),
        attitude=Readings(times, np.zeros((len(times), 3))),
        velocity=Readings(times, np.tile([SPEED, 0, 0], (len(times), 1))),
        depth=Readings(times, np.zeros((len(times), 1))),
        position=Readings(times[:1], np.zeros((1, 3))),
    )
    noise = 2e-5 * np.random.default_rng(1).normal(size=(len(times) * 80 * lasers, 3))
    return Pass(
        times,
        np.concatenate(profile),
        np.concatenate(line),
        np.concatenate(laser),
        np.concatenate(points) + noise,
        np.zeros(len(noise)),
        log,
    )


def off_course(path, times):
    """Give how far a path is from the true one along the way, but for a shift of all of it."""
    off = path.at(times).positions[:, 0] - SPEED * times - swing(times)
    return off - off.mean()


def test_two_sheets_find_a_swing_that_the_log_does_not_know():
    one = scan(1e-3)
    adjusted = adjust_passes([one], QUICK)
    inner = one.times[5:-5]
    logged, found = (off_course(paths[0], inner) for paths in (adjusted.as_logged, adjusted.paths))
    assert np.std(logged) > 3e-3
    assert np.std(found) < 0.2 * np.std(logged)


def test_one_sheet_and_one_pass_stay_at_the_log():
    one = scan(1e-3, lasers=1)
    adjusted = adjust_passes([one], QUICK)
    for before, after in zip(adjusted.as_logged, adjusted.paths, strict=True):
        np.testing.assert_allclose(after.positions, before.positions, atol=1e-6)


def test_a_plain_plate_shows_nothing_of_the_way_along_it():
    one = scan(0.0)
    adjusted = adjust_passes([one], QUICK)
    before, after = (p[0].at(one.times).positions for p in (adjusted.as_logged, adjusted.paths))
    # The log's own uncertainty of the way is 10 mm/s · √(0.05 s · 6 s) = 5 mm; a tenth of it.
    np.testing.assert_allclose(after[:, :2], before[:, :2], atol=0.5e-3)


def test_stated_errors_of_a_way_from_the_log_alone_are_those_of_its_accuracy():
    one = scan(0.0, lasers=1)
    trajectory = adjust_passes([one], QUICK).trajectory(0, one.times)
    ends = trajectory.errors[-1, 0] - trajectory.errors[0, 0]
    # White noise of 10 mm/s at 20 Hz adds up to 10 mm/s · √(6 s / 20 Hz); 64 draws know it to 9 %.
    np.testing.assert_allclose(np.linalg.norm(ends), 0.01 * np.sqrt(6 / 20), rtol=0.35)


def test_slopes_of_ties_are_what_small_steps_show():
    random = np.random.default_rng(2)
    knots = Knots.over(0.0, 2.0, 0.4)
    from scipy.spatial.transform import Rotation

    turns = Rotation.from_rotvec(random.normal(0, 0.1, (knots.num_controls, 3)))
    paths = [
        Path(knots, random.normal(size=(knots.num_controls, 3)),
             random.normal(0, 1e-3, (knots.num_controls, 3)), turns)
        for _ in range(2)
    ]  # fmt: skip
    direction = random.normal(size=(4, 3))
    ties = Ties(
        np.array([0, 0, 1, 1]), np.array([0.1, 0.9, 1.0, 1.9]), random.normal(size=(4, 3)),
        np.array([1, 0, 0, 1]), np.array([1.2, 1.7, 0.3, 0.2]), random.normal(size=(4, 3)),
        direction / np.linalg.norm(direction, axis=1, keepdims=True), np.zeros(4), np.ones(4),
    )  # fmt: skip
    here = linearise(ties, paths)
    steps = 1e-6 * random.normal(size=(2, paths[0].num_unknowns))
    there = linearise(ties, [p.moved(s) for p, s in zip(paths, steps, strict=True)])
    controls = steps.reshape(-1, 6)
    expected = np.zeros(4)
    for slopes, weights, first, sign in (
        (here.slopes_a, here.weights_a, here.first_a, 1),
        (here.slopes_b, here.weights_b, here.first_b, -1),
    ):
        near = controls[first[:, None] + np.arange(4)]
        expected += sign * np.einsum("nd,nj,njd->n", slopes, weights, near)
    np.testing.assert_allclose(there.residuals - here.residuals, expected, atol=1e-9)


def test_no_pass_is_refused():
    with pytest.raises(InputError, match="at least one pass"):
        adjust_passes([])


def test_readings_whose_clock_runs_backwards_are_refused():
    with pytest.raises(InputError, match="backwards"):
        Readings(np.array([1.0, 0.5]), np.zeros((2, 3)))
