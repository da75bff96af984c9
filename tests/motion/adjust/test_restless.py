"""Heaves and rolls that a way does not know of are no relief, and a seam across the way is."""

from dataclasses import replace

import numpy as np
import pytest

from murkscan.motion.adjust import AdjustSettings, Pass
from murkscan.motion.adjust.first_path import first_path, fit_path
from murkscan.motion.adjust.legs import cut_legs, make_facets
from murkscan.motion.adjust.normals import steady_normals
from murkscan.motion.adjust.relief import make_relief
from murkscan.motion.adjust.restless import slopes_of_errors
from murkscan.types.navigation import Navigation, NavigationAccuracy
from murkscan.types.trajectory import Trajectory

RATE, SPEED, STAND_OFF, LINES = 25.0, 0.1, 0.6, 160
STILL = Navigation(NavigationAccuracy())
TIMES = np.arange(int(6 * RATE)) / RATE
HEAVE = 0.3e-3
"""Of the vehicle [m], with a period of 0.6 s: slopes of 31 mrad at its steepest."""


def heave(times, phase=0.0):
    return HEAVE * np.sin(2 * np.pi * times / 0.6 + phase)


def along_way(x, y):
    """Give a seam of 3 mm along the way [m]."""
    return 3e-3 * np.exp(-0.5 * ((y - 0.03) / 4e-3) ** 2)


def across_way(x, y):
    """Give a seam of 3 mm across the way [m]."""
    return 3e-3 * np.exp(-0.5 * ((x - 0.3) / 4e-3) ** 2)


def plain(x, y):
    return 0 * x


def look(surface, *, heaves):
    """Give the facets of a leg of one who heaves, and a path that does not know."""
    places = np.stack([SPEED * TIMES, 0 * TIMES, 0 * TIMES], axis=1)
    way = Trajectory(TIMES, places, np.tile([1.0, 0, 0, 0], (len(TIMES), 1)))
    profile, line = np.divmod(np.arange(len(TIMES) * LINES), LINES)
    y = np.linspace(-0.15, 0.15, LINES)[line]
    depth = STAND_OFF - surface(places[profile, 0], y)
    depth = depth + 1e-4 * np.random.default_rng(0).normal(size=len(y))
    depth = depth - heaves * heave(TIMES[profile])
    points = np.stack([0 * y, y, depth], axis=1)
    one = Pass(TIMES, profile, line, 0 * line.astype(np.uint8), points, 0 * y, STILL, way)
    settings = AdjustSettings()
    path = fit_path(first_path(STILL, TIMES[0], TIMES[-1], settings.knot_step, way), way)
    (leg,) = cut_legs(0, one, path, settings.cell)
    return make_facets(leg, path), path


def draw(path, share):
    """Draw heaves of any phase, as the way may have, or a share of them."""
    phases = np.linspace(0, 2 * np.pi, 8, endpoint=False)
    errors = np.zeros((path.knots.num_controls, 6, len(phases)))
    for k, phase in enumerate(phases):
        errors[:, 2, k] = share * heave(path.knots.control_times, phase)
    return errors


def slopes(facets, path, share):
    steady, _ = steady_normals(facets, slopes_of_errors(facets, path, draw(path, share)))
    return -steady[:, :2] / steady[:, 2:]


def test_slopes_that_errors_make_are_those_of_a_heaving_way():
    facets, path = look(plain, heaves=1)
    made = np.sqrt(slopes_of_errors(facets, path, draw(path, 1.0)).mean(axis=0))
    assert made[0] == pytest.approx(np.std(facets.normals[:, 0] / facets.normals[:, 2]), rel=0.25)
    assert made[1] == pytest.approx(0, abs=1e-9)


def test_a_heave_that_the_way_may_have_shows_no_slopes():
    facets, path = look(plain, heaves=1)
    raw = np.std(facets.normals[:, 0])
    assert np.std(slopes(facets, path, 1.0)[:, 0]) < 0.1 * raw
    # Half of it is still explained by three standard deviations, a tenth is not.
    assert np.std(slopes(facets, path, 0.1)[:, 0]) > 0.8 * raw


def test_a_seam_along_the_way_shows_slopes_across_it_only():
    facets, path = look(along_way, heaves=0)
    found = slopes(facets, path, 0.0)
    raw = facets.normals[:, :2] / facets.normals[:, 2:]
    assert np.std(found[:, 1]) > 0.9 * np.std(raw[:, 1])
    assert np.std(found[:, 0]) < 0.1 * np.std(raw[:, 0])


def test_a_seam_across_the_way_shows_its_slopes_whatever_the_heave():
    facets, path = look(across_way, heaves=1)
    found = slopes(facets, path, 1.0)[:, 0]
    x = facets.points[:, 0]
    at_seam, elsewhere = np.abs(x - 0.3) < 8e-3, np.abs(x - 0.3) > 0.04
    raw = facets.normals[:, 0] / facets.normals[:, 2]
    assert np.std(found[at_seam]) > 0.8 * np.std(raw[at_seam])
    assert np.std(found[elsewhere]) < 0.1 * np.std(raw[elsewhere])


def test_heaves_are_no_relief_and_seams_are():
    facets, path = look(across_way, heaves=1)
    relief = make_relief(facets, path, draw(path, 1.0))
    at_seam = np.flatnonzero(np.abs(facets.points[:, 0] - 0.3) < 0.03)
    elsewhere = np.flatnonzero(np.abs(facets.points[:, 0] - 0.3) > 0.08)
    assert relief.is_flat(elsewhere)
    assert not relief.is_flat(at_seam)
    sure = make_relief(facets, path, 0 * draw(path, 1.0))
    assert not sure.is_flat(elsewhere)
    noisy = replace(relief, noise=relief.noise + 1e-4)
    assert noisy.is_flat(at_seam)
