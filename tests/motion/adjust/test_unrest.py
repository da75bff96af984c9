"""Usual accelerations are learnt where a path is known, and stay as assumed where it is not."""

from dataclasses import replace

import numpy as np
import pytest

from murkscan.motion.adjust.first_path import first_path
from murkscan.motion.adjust.log_terms import Log
from murkscan.motion.adjust.settings import AdjustSettings
from murkscan.motion.adjust.solve import State
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
    # Of a cubic spline, the mean of two neighbouring second differences bends its piece.
    moved = np.cumsum(np.cumsum(np.sqrt(2) * bends * SETTINGS.knot_step**2, axis=0), axis=0)
    return replace(path, positions=moved[:, :3], turns=moved[:, 3:])


def learn(path, navigation):
    layout = Layout.of([path], [0])
    logs = (Log(0, navigation, layout, 0.0),)
    for _ in range(3):  # as often as facets are paired, at least: a last piece is hardly held
        logs = learn_unrest(State((path,), np.zeros(layout.count)), logs, [], SETTINGS)
    return logs[0].unrest


def test_what_a_known_path_shows_is_learnt(restless):
    times = np.arange(0, DURATION, 0.02)
    sure = NavigationAccuracy(position_noise=1e-5, attitude_noise=1e-5)
    poses = restless.at(times)
    log = Navigation(
        sure,
        attitude=Readings(times, np.zeros((len(times), 3))),
        position=Readings(times, poses.positions),
    )
    # 150 pieces know a standard deviation to 6 %; neighbours share a bend.
    np.testing.assert_allclose(learn(restless, log), TRUE, rtol=0.2)


def test_what_nothing_holds_stays_as_it_was_assumed(restless):
    nothing = Navigation(NavigationAccuracy(attitude_noise=1.0))
    still = replace(restless, positions=0 * restless.positions, turns=0 * restless.turns)
    # 8 draws of 150 pieces know it to 2 %.
    assumed = Log(0, nothing, Layout.of([still], [0]), 0.0).unrest
    np.testing.assert_allclose(learn(still, nothing), assumed, rtol=0.1)
