"""Dead reckoning adds up what a vehicle's instruments say."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from murkscan.errors import InputError
from murkscan.motion.reckon import reckon
from murkscan.types.navigation import Navigation, NavigationAccuracy, Readings

TIMES = np.arange(0, 20, 0.1)


def navigation(heading, **measured) -> Navigation:
    angles = np.column_stack([0 * TIMES, 0 * TIMES, heading])
    return Navigation(NavigationAccuracy(), attitude=Readings(TIMES, angles), **measured)


def test_a_steady_turn_is_a_circle():
    rate, speed = 0.3, 0.2
    way = reckon(navigation(rate * TIMES), np.array([speed, 0, 0]))
    circle = speed / rate * np.stack([np.sin(rate * TIMES), 1 - np.cos(rate * TIMES)], axis=1)
    # Chords of 0.03 rad for arcs: 0.03²/12 of the radius.
    np.testing.assert_allclose(way.positions[:, :2], circle, atol=1e-4)
    ahead = Rotation.from_quat(way.quaternions, scalar_first=True).apply([1.0, 0, 0])
    np.testing.assert_allclose(ahead[:, 1], np.sin(rate * TIMES), atol=1e-12)


def test_measured_velocities_count_where_none_is_given():
    velocity = Readings(TIMES, np.tile([0.0, 0.1, 0.0], (len(TIMES), 1)))
    way = reckon(navigation(0 * TIMES, velocity=velocity))
    np.testing.assert_allclose(way.positions[:, 1], 0.1 * TIMES, atol=1e-12)


def test_the_gauge_holds_the_depth():
    heave = 5 + 0.05 * np.sin(2 * np.pi * TIMES / 8)
    way = reckon(
        navigation(0 * TIMES, depth=Readings(TIMES, heave[:, None])), np.array([1.0, 0, 0])
    )
    # A heave of eight seconds loses 3 % by the smoothing.
    np.testing.assert_allclose(way.positions[20:-20, 2], heave[20:-20], atol=0.003)


def test_without_velocity_there_is_no_way():
    with pytest.raises(InputError, match="velocity"):
        reckon(navigation(0 * TIMES))
