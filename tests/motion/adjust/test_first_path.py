"""A path follows a vehicle as closely as ties see it, and keeps what its log has measured once."""

import numpy as np
import pytest

from murkscan.motion.adjust.draws import draw_errors
from murkscan.motion.adjust.first_path import first_path, fit_path
from murkscan.motion.adjust.log_terms import Log
from murkscan.motion.adjust.settings import AdjustSettings
from murkscan.motion.adjust.solve import State, improve
from murkscan.motion.adjust.unknowns import Layout
from murkscan.simulate.vehicle import Unrest, drive
from murkscan.types.navigation import Navigation, NavigationAccuracy, Readings

pytestmark = pytest.mark.without_types

DURATION, SETTINGS = 10.0, AdjustSettings()


@pytest.mark.parametrize("seed", range(3))
def test_pieces_follow_a_small_vehicle_in_waves(seed):
    # The vehicle of the scene `two-lasers`, whose motion goes up to 1 Hz. Ties are good to 0.05 mm
    # each and there are thousands: what pieces cannot follow must stay far below.
    unrest = Unrest(speed=0.15, sway=6e-3, heave=8e-3, attitude=np.deg2rad(0.7), period=5.0)
    way = drive(unrest, np.array([0.1, 0, 0]), np.zeros(3), DURATION, seed=seed)
    way = way.at(np.arange(0, DURATION, 0.04))
    start = first_path(Navigation(NavigationAccuracy()), 0.0, DURATION, SETTINGS.knot_step, way)
    found = fit_path(start, way).as_trajectory(way.times)
    beside = np.tile([0.2, 0.25, 0.8], (len(way.times), 1))
    off = found.transform(beside, way.times) - way.transform(beside, way.times)
    assert np.sqrt(np.mean(off**2)) < 0.01e-3


def test_a_way_begins_where_it_is_laid_if_its_only_fix_was_taken_before():
    times = np.arange(0, DURATION, 0.1)
    still = np.zeros((len(times), 3))
    log = Navigation(
        NavigationAccuracy(velocity_noise=3e-3, attitude_noise=2e-3, position_noise=0.03),
        attitude=Readings(times, still),
        velocity=Readings(times, still),
        position=Readings(np.array([-60.0]), still[:1]),
    )
    path = first_path(log, 0.0, DURATION, SETTINGS.knot_step)
    layout = Layout.of([path], [0])
    origin, draws = np.array([1.0, 2.0, 3.0]), 200
    logs = (Log(0, log, layout, 0.0, origin, 0.2),)
    state = improve(State((path,), np.zeros(layout.count)), logs, [], SETTINGS, steps=4)
    drawn = draw_errors(state, logs, [], SETTINGS, count=draws)[: layout.sizes[0]]
    begin = state.paths[0].as_trajectory(times[:2], drawn.reshape(-1, 6, draws) / np.sqrt(draws))
    np.testing.assert_allclose(begin.positions[0], origin, atol=1e-6)
    # 200 draws know each deviation to 5 %.
    np.testing.assert_allclose(np.linalg.norm(begin.errors[0, :3], axis=1), 0.2, rtol=0.2)


@pytest.mark.parametrize("late", [-0.2, 0.0, 0.2])
def test_a_place_that_was_measured_once_holds_whatever_the_clock(late):
    accuracy = NavigationAccuracy(
        velocity_noise=3e-3, attitude_noise=2e-3, depth_noise=5e-3, position_noise=0.03,
        clock_offset=0.5,
    )  # fmt: skip
    times = np.arange(0, DURATION, 0.1)
    still = np.zeros((len(times), 3))
    log = Navigation(
        accuracy,
        attitude=Readings(times, still),
        velocity=Readings(times, still + np.array([0.1, 0, 0])),
        depth=Readings(times, still[:, :1]),
        position=Readings(times[:1], np.array([[0.4, 0.7, 0.0]])),
    )
    path = first_path(log, 0.0, DURATION, SETTINGS.knot_step)
    layout = Layout.of([path], [0])
    logs, errors = (Log(0, log, layout, 0.0),), np.zeros(layout.count)
    errors[layout.shared(0, "clock_offset")] = late
    state = improve(State((path,), errors), logs, [], SETTINGS, steps=4)
    draws = 200
    drawn = draw_errors(state, logs, [], SETTINGS, count=draws)[: layout.sizes[0]]
    begin = state.paths[0].as_trajectory(times[:2], drawn.reshape(-1, 6, draws) / np.sqrt(draws))
    sigma = np.linalg.norm(begin.errors[0, :2], axis=1)
    # The fix, and 0.5 s of the clock at 0.1 m/s along the way; 200 draws know each to 5 %.
    np.testing.assert_allclose(sigma, [np.hypot(0.03, 0.05), 0.03], rtol=0.2)
    assert np.abs(begin.positions[0, 1] - 0.7) < 1e-3


@pytest.mark.parametrize("per_piece", [0.5, 1, 2])
def test_a_log_that_is_read_at_the_knots_leaves_nothing_free(per_piece):
    """Controls that alternate have no velocity at the knots; a fix that is off would bring them."""
    accuracy = NavigationAccuracy(velocity_noise=3e-3, attitude_noise=2e-3, position_noise=0.03)
    times = np.arange(0, DURATION, SETTINGS.knot_step / per_piece)
    still = np.zeros((len(times), 3))
    log = Navigation(
        accuracy,
        attitude=Readings(times, still),
        velocity=Readings(times, still + np.array([0.1, 0, 0])),
        position=Readings(times[:1], np.array([[0.0, 0.05, 0.0]])),
    )
    path = first_path(log, 0.0, DURATION, SETTINGS.knot_step)
    layout = Layout.of([path], [0])
    logs = (Log(0, log, layout, 0.0),)
    state = improve(State((path,), np.zeros(layout.count)), logs, [], SETTINGS, steps=4)
    draws = 100
    drawn = draw_errors(state, logs, [], SETTINGS, count=draws)[: layout.sizes[0]]
    begin = state.paths[0].as_trajectory(
        np.array([0.0, 0.5]), drawn.reshape(-1, 6, draws) / np.sqrt(draws)
    )
    moved = np.linalg.norm(begin.errors[1, :3] - begin.errors[0, :3], axis=1)
    # Half a second at 3 mm/s a reading, and at most 0.2 m/s² between two of them.
    assert np.all(moved < 3e-3), moved
