"""Poses that no vehicle can have reached, and those that only look so."""

import numpy as np
import pytest

from murkscan.io.poses import load_poses
from murkscan.motion.excursions import leave_out_excursions
from murkscan.types.trajectory import Trajectory

TIMES = np.arange(2000) * 0.02
UTM = np.stack([452310 + 0.5 * TIMES, 4163870 + 0 * TIMES, 5 + 0.1 * np.sin(TIMES)], axis=1)
NUMBER = np.arange(2000)[:, None]


def log_of(places):
    return Trajectory(TIMES, places, np.tile([1.0, 0, 0, 0], (len(TIMES), 1)))


NOISE = np.random.default_rng(0)
SOUND = {
    "as it is": UTM,
    "a millimetre of noise": UTM + NOISE.normal(0, 1e-3, UTM.shape),
    "a metre of noise": UTM + NOISE.normal(0, 1, UTM.shape),
    "centimetres": UTM.round(2),
    "corrected from outside every second": UTM
    + np.repeat(NOISE.normal(0, 0.5, (40, 3)), 50, axis=0),
    "a jump that stays": UTM + np.where(NUMBER > 700, 3.0, 0.0),
    "a sprint": UTM + np.clip(TIMES - 20, 0, 1)[:, None] * 3,
    "a halt": np.where(NUMBER > 1000, UTM[1000], UTM),
}


@pytest.mark.parametrize("kind", SOUND)
def test_what_a_vehicle_or_a_filter_does_stays(kind):
    log = log_of(SOUND[kind])
    left, found = leave_out_excursions(log)
    assert found == ()
    np.testing.assert_array_equal(left.positions, log.positions)


LOST = {
    "one": NUMBER == 500,
    "many": (NUMBER // 100) % 5 == 3,
    "at the beginning": NUMBER < 70,
    "at the end": NUMBER >= 1900,
}


@pytest.mark.parametrize("kind", LOST)
def test_zeros_of_a_lost_fix_go_and_all_else_stays(kind):
    left, found = leave_out_excursions(log_of(np.where(LOST[kind], 0.0, UTM)))
    np.testing.assert_array_equal(left.times, TIMES[~LOST[kind][:, 0]])
    assert sum(one.count for one in found) == LOST[kind].sum()


def test_garbage_that_differs_from_pose_to_pose_goes():
    places = UTM.copy()
    places[500], places[501], places[900] = 1e7, -3e6, UTM[900] + [0, 2, 0]
    left, found = leave_out_excursions(log_of(places))
    assert [(one.begin, one.end, one.count) for one in found] == [(10.0, 10.02, 2), (18.0, 18.0, 1)]
    assert found[1].distance == pytest.approx(2, abs=0.02)
    assert len(left.times) == 1997


@pytest.mark.parametrize("name", ["bus_outside", "cave", "cemetery"])
def test_real_tracks_have_none(data, name):
    _, found = leave_out_excursions(load_poses(data("underwater_trajectories") / f"{name}.txt"))
    assert found == ()


@pytest.mark.parametrize("count", [1, 2, 3])
def test_short_logs_stay(count):
    log = Trajectory(TIMES[:count], UTM[:count], np.tile([1.0, 0, 0, 0], (count, 1)))
    assert leave_out_excursions(log)[1] == ()
