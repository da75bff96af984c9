"""What instruments say of a path: slopes against differences, and a log that is met."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from murkscan.motion.adjust.instruments import Heading, Place, Rates, Tilt, Velocity
from murkscan.motion.adjust.path import Path, left_jacobian
from murkscan.motion.adjust.spline import Knots, evaluate, evaluate_rotation

INSTRUMENTS = [Tilt(), Heading(1.0), Velocity(), Rates(), Place((0, 1, 2)), Place((2,))]
TIMES = np.array([0.1, 0.9, 1.55, 2.3])
KNOTS = Knots.over(0.0, 2.4, 0.4)


@pytest.fixture
def path():
    random = np.random.default_rng(3)
    count = KNOTS.num_controls
    reference = Rotation.from_rotvec(np.cumsum(random.normal(0, 0.05, (count, 3)), axis=0))
    return Path(
        KNOTS, random.normal(size=(count, 3)), random.normal(0, 1e-4, (count, 3)), reference
    )


@pytest.mark.parametrize("instrument", INSTRUMENTS, ids=lambda i: type(i).__name__)
def test_slopes_are_what_small_steps_show(path, instrument):
    poses = path.at(TIMES)
    slopes = instrument.slopes(path, poses)
    # A step of 1e-5 leaves second-order terms of 1e-5 of the slopes, and rounding far below.
    step = 1e-5 * np.random.default_rng(0).normal(size=path.num_unknowns)
    near = step.reshape(-1, 6)[poses.first[:, None] + np.arange(4)]
    expected = np.einsum("njmd,njd->nm", slopes, near)
    ahead, behind = (
        instrument.predict(other, other.at(TIMES))
        for other in (path.moved(step), path.moved(-step))
    )
    found = instrument.subtract(ahead, behind) / 2
    np.testing.assert_allclose(found, expected, atol=2e-3 * np.abs(expected).max())


@pytest.mark.parametrize("turned", [1e-4, 0.5])
def test_poses_are_what_the_splines_say(path, turned):
    turns = turned * np.random.default_rng(1).normal(size=path.turns.shape)
    path = replace(path, turns=turns)
    poses, by = path.at(TIMES), evaluate(KNOTS, turns, TIMES)
    turned_about = Rotation.from_rotvec(by) * evaluate_rotation(KNOTS, path.reference, TIMES)
    np.testing.assert_allclose(poses.rotations, turned_about.as_matrix(), atol=1e-12)
    np.testing.assert_allclose(poses.positions, evaluate(KNOTS, path.positions, TIMES), atol=1e-12)
    np.testing.assert_allclose(poses.turned_by, left_jacobian(by), atol=1e-12)


def test_velocity_and_rates_are_the_derivatives_of_the_path(path):
    step = 1e-5
    ahead, behind = path.at(TIMES + step), path.at(TIMES - step)
    velocity = (ahead.positions - behind.positions) / (2 * step)
    np.testing.assert_allclose(path.velocity(TIMES), velocity, rtol=1e-6, atol=1e-8)
    turn = Rotation.from_matrix(ahead.rotations) * Rotation.from_matrix(behind.rotations).inv()
    np.testing.assert_allclose(path.rates(TIMES), turn.as_rotvec() / (2 * step), atol=1e-6)


def test_a_reference_that_does_not_turn_stays_as_it_is():
    still = Rotation.from_rotvec(np.tile([0.1, -0.2, 0.3], (KNOTS.num_controls, 1)))
    turned = evaluate_rotation(KNOTS, still, TIMES).as_rotvec()
    np.testing.assert_allclose(turned, np.tile([0.1, -0.2, 0.3], (4, 1)), atol=1e-12)


def test_a_trajectory_carries_its_errors_to_points_far_from_it(path):
    errors = np.zeros((KNOTS.num_controls, 6, 2))
    errors[:, 0, 0] = 1e-3
    errors[:, 5, 1] = 1e-3
    trajectory = replace(path, turns=np.zeros_like(path.turns)).as_trajectory(TIMES, errors)
    points = trajectory.positions + np.array([0.0, 2.0, 0.0])
    shifts = trajectory.shifts(points, TIMES)
    np.testing.assert_allclose(shifts[:, :, 0], np.tile([1e-3, 0, 0], (4, 1)), atol=1e-12)
    # A turn of 1 mrad about the third axis moves what lies 2 m along the second by -2 mm.
    np.testing.assert_allclose(shifts[:, :, 1], np.tile([-2e-3, 0, 0], (4, 1)), atol=1e-12)
