"""Usual accelerations are learnt where a path is known, and stay as assumed where it is not."""

from dataclasses import replace

import numpy as np
import pytest

from murkscan.motion.adjust.draws import draw_errors
from murkscan.motion.adjust.first_path import first_path
from murkscan.motion.adjust.log_terms import UNREST, Log
from murkscan.motion.adjust.settings import AdjustSettings
from murkscan.motion.adjust.solve import State
from murkscan.motion.adjust.ties import Ties, as_seen
from murkscan.motion.adjust.unknowns import Layout
from murkscan.motion.adjust.unrest import learn_unrest
from murkscan.types.navigation import Navigation, NavigationAccuracy, Readings

DURATION, SETTINGS = 30.0, AdjustSettings()
TRUE = np.array([0.03, 0.01, 0.02, 0.05, 0.1, 0.02])
"""Along the world's axes [m/s²], and about them [rad/s²]."""


@pytest.fixture
def restless():
    """Give a path whose control values bend by as much, at random."""
    path = first_path(Navigation(NavigationAccuracy()), 0.0, DURATION, SETTINGS.knot_step)
    bends = np.random.default_rng(0).normal(size=(path.knots.num_controls, 6)) * TRUE
    # An acceleration lasts for two pieces of a cubic spline: three second differences, of which the
    # middle one counts twice, bend them.
    moved = np.cumsum(np.cumsum(np.sqrt(8 / 3) * bends * SETTINGS.knot_step**2, axis=0), axis=0)
    return replace(path, positions=moved[:, :3], turns=moved[:, 3:])


def learn(path, accuracy, *, tied):
    """Learn the unrest of a path, and of one that its log holds still; tie both, or do not."""
    still = replace(path, positions=0 * path.positions, turns=0 * path.turns)
    times, paths = np.arange(0, DURATION, 0.1), (path, still)
    sure = NavigationAccuracy(position_noise=1e-6, attitude_noise=1e-6)
    held = Readings(times, np.zeros((len(times), 3)))
    log = Navigation(sure, attitude=held, position=held)
    layout = Layout.of(paths, [0, 1])
    logs = Log(0, Navigation(accuracy), layout, 0.0), Log(1, log, layout, 0.0)
    groups = [tie_all(paths, np.arange(0, DURATION, 0.04))] if tied else []
    state = State(paths, np.zeros(layout.count))
    for _ in range(4):  # about as often as facets are paired
        errors = draw_errors(state, logs, groups, SETTINGS, count=8)
        logs = learn_unrest(state, logs, errors, SETTINGS)
    return logs[0].unrest


def tie_all(paths, times):
    """Tie four places, along all directions, to where both passes see them at some times."""
    places = np.array([[0.3, 0, 0.6], [-0.3, 0, 0.6], [0, 0.3, 0.6], [0, -0.3, 0.9]])
    count = 12 * len(times)
    moments, points = np.repeat(times, 12), np.tile(np.repeat(places, 3, axis=0), (len(times), 1))
    first = np.zeros(count, np.int64)
    own = [as_seen(first + number, moments, points, paths) for number in (0, 1)]
    return Ties(
        first, moments, own[0], first + 1, moments, own[1],
        np.tile(np.eye(3), (count // 3, 1)), np.zeros(count), np.full(count, 1e-12),
    )  # fmt: skip


def test_what_ties_show_is_learnt(restless):
    # 150 pieces know a standard deviation to 6 %; neighbours share a bend.
    found = learn(restless, NavigationAccuracy(), tied=True)
    np.testing.assert_allclose(found[:3], TRUE[:3], rtol=0.25)
    # An attitude of which nothing is known wanders by itself, less than turns are to be usual.
    assert np.all(np.array(found[3:]) < 0.4)


def test_turns_away_from_a_measured_attitude_are_no_unrest(restless):
    found = learn(restless, NavigationAccuracy(attitude_noise=1e-3), tied=True)
    np.testing.assert_allclose(found, [*TRUE[:3], 0.4, 0.4, 0.4], rtol=0.25)


def test_what_nothing_shows_stays_as_it_was_assumed(restless):
    still = replace(restless, positions=0 * restless.positions, turns=0 * restless.turns)
    assert learn(still, NavigationAccuracy(), tied=False) == pytest.approx(UNREST)
