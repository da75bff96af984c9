"""The errors that are stated for a path are those it has: neither half nor twice."""

from itertools import combinations

import numpy as np
import pytest

from murkscan.motion.adjust.draws import draw_errors
from murkscan.motion.adjust.first_path import first_path
from murkscan.motion.adjust.log_terms import Log
from murkscan.motion.adjust.settings import AdjustSettings
from murkscan.motion.adjust.solve import State, improve
from murkscan.motion.adjust.ties import Ties
from murkscan.motion.adjust.unknowns import Layout
from murkscan.types.navigation import Navigation, NavigationAccuracy, Readings

pytestmark = pytest.mark.without_types

DURATION, SPEED, GAP = 5.0, 0.1, 0.08
SEEDS, DRAWS = 24, 32
SETTINGS = AdjustSettings()
ACCURACY = NavigationAccuracy(
    velocity_noise=5e-3, velocity_bias=2e-3, attitude_noise=1e-3, depth_noise=3e-3,
    position_noise=1e-3,
)  # fmt: skip


def read_log(random):
    """Read the log of a vehicle that goes straight along x at 0.1 m/s, ten times a second."""
    times = np.arange(0, DURATION + 0.05, 0.1)
    zero = np.zeros((len(times), 3))
    velocity = zero + [SPEED, 0, 0] + ACCURACY.velocity_bias * random.normal(size=3)
    velocity += ACCURACY.velocity_noise * random.normal(size=zero.shape)
    attitude = ACCURACY.attitude_noise * random.normal(size=zero.shape)
    # A heading is off by as much as it is noisy: where its drift counts from is not stated.
    attitude[:, 2] += ACCURACY.attitude_noise * random.normal()
    return Navigation(
        ACCURACY,
        attitude=Readings(times, attitude),
        velocity=Readings(times, velocity),
        depth=Readings(times, ACCURACY.depth_noise * random.normal(size=(len(times), 1))),
        position=Readings(times[:1], ACCURACY.position_noise * random.normal(size=(1, 3))),
    )


def tie(random, looks):
    """Tie what some sheets saw 0.8 s apart on bumps; noise goes together over 20 mm, as planes do.

    One look in a hundred is false, off by some noise's standard deviations.
    """
    times, across = np.meshgrid(np.arange(1.0, DURATION - 0.1, 0.05), np.linspace(-0.15, 0.15, 30))
    times, across = times.ravel(), across.ravel()
    count = len(times)
    slopes = 0.05 * random.normal(size=(count, 2))
    direction = np.column_stack([slopes, np.ones(count)])
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    cells = np.floor(times / 0.2).astype(int) * 100 + np.floor(across / 0.02).astype(int) + 50
    noise = 0.07e-3 * random.normal(size=(looks, count))
    noise += 0.035e-3 * random.normal(size=(looks, cells.max() + 1))[:, cells]
    noise[random.random((looks, count)) < 0.01] *= 6
    own = np.column_stack([np.zeros(count), across, np.full(count, 0.6)])
    which, variance = np.zeros(count, np.int64), np.full(count, (0.12e-3) ** 2)

    def at(look):
        return which, times - look * GAP / SPEED, own + np.array([look * GAP, 0, 0])

    # What lies before the recording's beginning was not looked at.
    return [
        Ties(*at(a), *at(b), direction, noise[a] - noise[b], variance)[times > b * GAP / SPEED]
        for a, b in combinations(range(looks), 2)
    ]


def pulls(seed, looks=2):
    """Divide errors of length, sagitta, and of the way between two sheets, by what is stated."""
    random = np.random.default_rng(seed)
    log = read_log(random)
    path = first_path(log, 0.0, DURATION, SETTINGS.knot_step)
    layout = Layout.of([path], [0])
    logs = (Log(0, log, layout, 0.0),)
    state = improve(State((path,), np.zeros(layout.count)), logs, [], SETTINGS, steps=4)
    groups = tie(random, looks)
    for _ in range(3):  # as ties come to fit, their spread is known better
        state = improve(state, logs, groups, SETTINGS, steps=4)
    errors = draw_errors(state, logs, groups, SETTINGS, count=DRAWS, as_seen=True)
    errors = errors[: layout.sizes[0]].reshape(-1, 6, DRAWS) / np.sqrt(DRAWS)
    times = np.array([0.5, DURATION / 2, DURATION / 2 + GAP / SPEED, DURATION - 0.5])
    found = state.paths[0].as_trajectory(times, errors)
    off = found.positions - np.outer(times, [SPEED, 0, 0])
    shifts = found.errors[:, :3]
    ends, bend, gap = np.array([[-1, 0, 0, 1], [-0.5, 1, 0, -0.5], [0, -1, 1, 0]])
    asked = [(weights, axis) for weights in (ends, bend, gap) for axis in range(3)]
    return [
        float(weights @ off[:, axis] / np.linalg.norm(weights @ shifts[:, axis]))
        for weights, axis in asked
    ]


@pytest.fixture(scope="module")
def all_pulls():
    return np.array([pulls(seed) for seed in range(SEEDS)])


@pytest.fixture(scope="module")
def four_looks():
    return np.array([pulls(seed, looks=4)[-3:] for seed in range(SEEDS)])


def test_errors_of_lengths_and_bends_are_as_large_as_stated(all_pulls):
    # 144 pulls, of which those of one seed go together: their RMS is known to about 8 %, and 32
    # draws know each stated deviation to 12 %. Half or twice the deviation would be 2 or 0.5.
    assert 0.75 < np.sqrt(np.mean(all_pulls**2)) < 1.35


def test_each_kind_of_error_is_as_large_as_stated(all_pulls):
    spread = np.sqrt(np.mean(all_pulls**2, axis=0))
    assert np.all((spread > 0.6) & (spread < 1.6)), spread


def test_ties_of_four_looks_at_a_place_are_no_six_independent_ones(four_looks):
    # Of six ties and four noises: counted as independent, the deviations would be 0.7 of the true
    # ones. 72 pulls know their RMS to 8 %.
    assert 0.75 < np.sqrt(np.mean(four_looks**2)) < 1.25
