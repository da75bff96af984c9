"""A motion's errors are as large as they are stated: neither half of it nor twice."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from scipy.stats import norm

from murkscan.errors import InputError
from murkscan.io.parquet import load_pose_errors, save_pose_errors
from murkscan.motion import ConstantSpeed, ConstantStep, PoseLog
from murkscan.optics.length import measure_length
from murkscan.types.navigation import NavigationAccuracy
from murkscan.types.pose import Pose
from murkscan.types.trajectory import Trajectory

TIMES = np.arange(0, 40.1, 0.2)
"""Of the log [s]; every second of them is a frame, so that nothing is interpolated."""
FRAMES = TIMES[::2][3:-3]
ARM = Pose(np.eye(3), np.array([0.3, 0.0, 0.4]))
DRAWS = 80


def way(times):
    """A vehicle that goes in a wide curve, rolling a little."""
    heading = 0.02 * times
    places = np.stack([20 * np.sin(heading), 20 * (1 - np.cos(heading)), 0.1 * np.sin(times)], 1)
    attitude = Rotation.from_euler("ZYX", np.stack([heading, 0 * times, 0.05 * np.sin(times)], 1))
    return Trajectory(times, places, attitude.as_quat(scalar_first=True))


def turned(log, turns, *, in_world=False):
    attitudes, by = Rotation.from_quat(log.quaternions, scalar_first=True), Rotation.from_rotvec
    both = by(turns) * attitudes if in_world else attitudes * by(turns)
    return replace(log, quaternions=both.as_quat(scalar_first=True))


def drift(log, bias):
    matrices = Rotation.from_quat(log.quaternions, scalar_first=True).as_matrix()
    return np.cumsum(matrices @ bias * 0.2, axis=0)


UP = np.array([0.0, 0.0, 1.0])
LEVEL = np.array([1.0, 1.0, 0.0])
KINDS = {
    "position_noise": (0.05, lambda log, s, r: replace(
        log, positions=log.positions + s * r.normal(size=log.positions.shape))),
    "depth_noise": (0.01, lambda log, s, r: replace(
        log, positions=log.positions + s * r.normal(size=(len(TIMES), 1)) * UP)),
    "velocity_bias": (0.002, lambda log, s, r: replace(
        log, positions=log.positions + drift(log, s * r.normal(size=3)))),
    "speed": (0.05, lambda log, s, r: replace(log, positions=log.positions * (1 + s * r.normal()))),
    "attitude_noise": (0.01, lambda log, s, r: turned(
        turned(log, s * r.normal(size=(len(TIMES), 3)) * LEVEL),
        s * r.normal(size=(len(TIMES), 1)) * UP, in_world=True)),
    "attitude_bias": (0.01, lambda log, s, r: turned(
        log, np.tile(s * r.normal(size=3) * LEVEL, (len(TIMES), 1)))),
    "heading_noise": (0.02, lambda log, s, r: turned(
        log, s * r.normal(size=(len(TIMES), 1)) * UP, in_world=True)),
    "heading_drift": (1e-3, lambda log, s, r: turned(
        log, s * r.normal() * TIMES[:, None] * UP, in_world=True)),
    "clock_offset": (0.05, lambda log, s, r: replace(log, times=TIMES + s * r.normal())),
    "clock_drift": (1e-3, lambda log, s, r: replace(log, times=TIMES * (1 + s * r.normal()))),
}  # fmt: skip
"""Of each kind a standard deviation, and a log with a drawn error of it."""


RECKONED = ("velocity_bias", "speed", "depth_noise")


@pytest.mark.parametrize("kind", KINDS)
def test_a_log_errs_between_two_frames_by_what_its_accuracy_says(kind):
    sigma, spoil = KINDS[kind]
    random = np.random.default_rng(1)
    first, second = random.integers(0, len(FRAMES), (2, 60))
    points = np.zeros((len(FRAMES), 3))
    truth = way(FRAMES).follow_mount(ARM).transform(points, FRAMES)
    # Where the noise of positions is stated, as nothing here, a log is not taken for reckoned.
    placed = {} if kind in RECKONED else {"position_noise": 1e-12}
    stated = PoseLog(way(TIMES), ARM, stated=NavigationAccuracy(**placed | {kind: sigma}))
    shifts = stated.follow(FRAMES, FRAMES).shifts(truth, FRAMES)
    expected = np.mean(np.sum((shifts[first] - shifts[second]) ** 2, axis=(1, 2)))
    found = []
    for _ in range(DRAWS):
        wrong = spoil(way(TIMES), sigma, random)
        moved = PoseLog(wrong, ARM).follow(FRAMES, FRAMES).transform(points, FRAMES) - truth
        found.append(np.mean(np.sum((moved[first] - moved[second]) ** 2, axis=1)))
    # 80 draws tell a deviation to 8 %, waves of noise are no white noise to some more.
    assert 0.75 < np.sqrt(np.mean(found) / expected) < 1.33


def test_a_reckoned_log_is_led_astray_by_its_attitude():
    """Where no noise of positions is stated; a gauge holds the depth."""
    accuracy = NavigationAccuracy(attitude_bias=0.01, heading_drift=1e-3, depth_noise=1e-9)
    shifts = PoseLog(way(TIMES), stated=accuracy).follow(FRAMES, FRAMES).errors[:, :3]
    random, found = np.random.default_rng(2), []
    steps = np.diff(way(FRAMES).positions, axis=0, prepend=way(FRAMES).positions[:1])
    axes = Rotation.from_quat(way(FRAMES).quaternions, scalar_first=True).as_matrix()
    for _ in range(400):
        bias = axes[:, :, :2] @ (0.01 * random.normal(size=2))
        drift = 1e-3 * random.normal() * (FRAMES - FRAMES[0])[:, None] * UP
        moved = np.cumsum(Rotation.from_rotvec(bias + drift).apply(steps) - steps, axis=0)
        found.append(moved[-1, :2])
    expected = np.sum(shifts[-1, :2] ** 2)
    # 400 draws of two numbers tell a deviation to 3 %.
    assert 0.85 < np.sqrt(np.mean(np.sum(np.square(found), axis=1)) / expected) < 1.18
    assert np.abs(shifts[:, 2]).max() < 1e-8


@pytest.mark.parametrize("motion", [
    ConstantSpeed(-0.02, "x", sigma=0.07), ConstantStep(0.0008, "y", sigma=0.03),
])  # fmt: skip
def test_a_length_along_the_motion_holds_the_truth_in_95_of_100_scans(motion):
    times = np.arange(250) / 25
    trajectory = motion.follow(times, np.arange(250.0))
    ends = trajectory.positions[[10, 240]] + [0.0, 0.0, 0.5]
    length = measure_length(ends, np.zeros((2, 3)), trajectory.shifts(ends, times[[10, 240]]))
    # The vehicles of 400 scans, as fast as quantiles of the normal distribution say.
    off = norm.ppf((np.arange(400) + 0.5) / 400) * motion.sigma * length.value
    covered = np.mean(np.abs(off) < 1.96 * length.sigma)
    assert 0.93 < covered < 0.97  # half the deviation would hold 67 of 100, twice 99.99


def test_who_states_nothing_has_no_errors():
    assert PoseLog(way(TIMES)).follow(FRAMES, FRAMES).errors is None
    assert PoseLog(way(TIMES)).accuracy == ""
    only_rates = PoseLog(way(TIMES), stated=NavigationAccuracy(rate_noise=0.1))
    assert only_rates.follow(FRAMES, FRAMES).errors is None
    with pytest.raises(InputError, match="0 to below 100 %"):
        ConstantSpeed(0.1, "x", sigma=1.0)


def test_errors_are_kept_in_single_precision(tmp_path):
    accuracy = NavigationAccuracy(position_noise=0.05, attitude_noise=0.01, clock_offset=0.1)
    errors = PoseLog(way(TIMES), stated=accuracy).follow(FRAMES, FRAMES).errors
    save_pose_errors(tmp_path / "errors.parquet", errors)
    found = load_pose_errors(tmp_path / "errors.parquet")
    np.testing.assert_array_equal(found, errors.astype(np.float32))
