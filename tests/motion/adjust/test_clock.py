"""A log's clock is found from what a scan shows of how its vehicle rolls, as surely as stated."""

import numpy as np
import pytest

from murkscan.motion.adjust.draws import draw_errors
from murkscan.motion.adjust.first_path import first_path, fit_path
from murkscan.motion.adjust.log_terms import Log
from murkscan.motion.adjust.settings import AdjustSettings
from murkscan.motion.adjust.solve import State, improve
from murkscan.motion.adjust.ties import Ties, as_seen
from murkscan.motion.adjust.unknowns import Layout
from murkscan.simulate.vehicle import Unrest, drive
from murkscan.types.navigation import Navigation, NavigationAccuracy, Readings

pytestmark = pytest.mark.without_types

DURATION, SPEED, GAP, LATE = 10.0, 0.1, 0.08, 0.01
SEEDS, DRAWS = 4, 64
SETTINGS = AdjustSettings()
ACCURACY = NavigationAccuracy(
    velocity_noise=3e-3, attitude_noise=np.deg2rad(0.1), depth_noise=5e-3, position_noise=0.03,
    clock_offset=0.5,
)  # fmt: skip
WAVES = Unrest(attitude=np.deg2rad(0.7), period=5.0)


def read_log(way, random):
    """Read a vehicle's instruments ten times a second, stamped late."""
    times = np.arange(0, DURATION, 0.1)
    poses, shape = way.at(times), (len(times), 3)
    attitude = poses.attitudes.as_euler("ZYX")[:, ::-1]
    velocity = poses.attitudes.inv().apply(np.tile([SPEED, 0, 0], (len(times), 1)))
    depth = poses.positions[:, 2:] + ACCURACY.depth_noise * random.normal(size=(len(times), 1))
    return Navigation(
        ACCURACY,
        attitude=Readings(
            times + LATE, attitude + ACCURACY.attitude_noise * random.normal(size=shape)
        ),
        velocity=Readings(
            times + LATE, velocity + ACCURACY.velocity_noise * random.normal(size=shape)
        ),
        depth=Readings(times + LATE, depth),
        position=Readings(times[:1], poses.positions[:1]),
    )


def tie(true, random):
    """Tie what two sheets saw of bumps, GAP / SPEED apart; noise of 0.1 mm each."""
    times, across = np.meshgrid(np.arange(1.0, DURATION - 0.1, 0.05), np.linspace(-0.2, 0.2, 12))
    times, count = times.ravel(), times.size
    places = np.column_stack([SPEED * times, across.ravel(), np.full(count, 0.8)])
    direction = np.column_stack([0.05 * random.normal(size=(count, 2)), np.ones(count)])
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    which, before = np.zeros(count, np.int64), times - GAP / SPEED
    seen = (as_seen(which, at, places, (true,)) for at in (times, before))
    (a, b), offset = seen, 0.1e-3 * random.normal(size=count)
    variance = np.full(count, (0.1e-3) ** 2)
    return Ties(which, times, a, which, before, b, direction, offset, variance)


def clock_pull(seed):
    """Divide the error of the clock by what is stated of it."""
    random = np.random.default_rng(seed)
    way = drive(WAVES, np.array([SPEED, 0, 0]), np.zeros(3), DURATION, seed=seed)
    log = read_log(way, random)
    moments = np.arange(0, DURATION, 0.02)
    path = first_path(log, 0.0, DURATION, SETTINGS.knot_step)
    layout = Layout.of([path], [0])
    ties = [tie(fit_path(path, way.at(moments)), random)]
    logs = (Log(0, log, layout, 0.0),)
    state = improve(State((path,), np.zeros(layout.count)), logs, [], SETTINGS, steps=4)
    for _ in range(3):
        state = improve(state, logs, ties, SETTINGS, steps=4)
    place = layout.shared(0, "clock_offset")
    drawn = draw_errors(state, logs, ties, SETTINGS, count=DRAWS, as_seen=True)[place]
    return (state.errors[place] + LATE) / float(np.sqrt(np.mean(drawn**2)))


def test_a_clock_is_off_by_as_much_as_stated():
    pulls = np.array([clock_pull(seed) for seed in range(SEEDS)])
    # Four pulls know their RMS to 35 % and their mean to 0.5; 64 draws know a deviation to 9 %.
    # Were rates taken for true that are a path's noise, pulls would be 2.6, all of one sign.
    assert 0.3 < np.sqrt(np.mean(pulls**2)) < 1.8, pulls
    assert abs(pulls.mean()) < 1.25, pulls
