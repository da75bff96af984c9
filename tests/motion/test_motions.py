"""What every motion promises; a new motion joins the list and inherits the tests."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from murkscan.errors import InputError
from murkscan.motion import ConstantSpeed, ConstantStep, PoseLog
from murkscan.types.pose import Pose
from murkscan.types.trajectory import Trajectory

LOG = Trajectory(
    np.array([0.0, 100.0]), np.array([[0.0, 0, 0], [50, 0, 0]]), np.tile([1.0, 0, 0, 0], (2, 1))
)
MOTIONS = [ConstantSpeed(0.5, "x"), ConstantStep(0.02, "x"), PoseLog(LOG)]
TIMES = np.arange(50) / 25
PICTURES = np.arange(50.0)


@pytest.mark.parametrize("motion", MOTIONS, ids=lambda m: type(m).__name__)
def test_there_is_a_pose_for_each_frame(motion):
    trajectory = motion.follow(TIMES, PICTURES)
    np.testing.assert_array_equal(trajectory.times, TIMES)


@pytest.mark.parametrize("motion", MOTIONS, ids=lambda m: type(m).__name__)
def test_half_a_metre_a_second_is_two_centimetres_a_frame(motion):
    steps = np.diff(motion.follow(TIMES, PICTURES).positions, axis=0)
    np.testing.assert_allclose(steps, np.tile([0.02, 0, 0], (49, 1)), atol=1e-12)


@pytest.mark.parametrize("motion", [ConstantSpeed(-0.5, "y"), ConstantStep(-0.02, "y")])
def test_the_first_frame_is_the_world_and_negative_goes_the_other_way(motion):
    trajectory = motion.follow(TIMES + 7, PICTURES + 3)
    np.testing.assert_array_equal(trajectory.positions[0], 0)
    np.testing.assert_allclose(trajectory.positions[-1], [0, -0.98, 0], atol=1e-12)


def test_a_field_moves_by_half_a_step():
    trajectory = ConstantStep(0.01, "x").follow(np.arange(4) / 50, np.arange(4) / 2)
    np.testing.assert_allclose(trajectory.positions[:, 0], [0, 0.005, 0.01, 0.015])


@pytest.mark.parametrize("make", [ConstantSpeed, ConstantStep])
@pytest.mark.parametrize("pace", [0.0, np.nan, np.inf])
def test_a_pace_that_moves_nothing_is_refused(make, pace):
    with pytest.raises(InputError, match="other than 0"):
        make(pace, "x")


def test_a_recording_outside_the_log_names_both_intervals_and_the_flags():
    with pytest.raises(InputError, match=r"120\.000 to 121\.960.*0\.000 to 100\.000") as error:
        PoseLog(LOG, start_time=120.0).follow(TIMES, PICTURES)
    assert "--start-time" in str(error.value)
    assert "--time-offset-s" in str(error.value)


def test_the_clock_of_the_log_is_shifted_by_start_and_offset():
    late = PoseLog(LOG, start_time=10.0, time_offset=2.0).follow(TIMES, PICTURES)
    np.testing.assert_allclose(late.positions[0], [6, 0, 0])


def test_a_mount_turns_with_the_vehicle():
    """A camera 1 m ahead of a vehicle that yaws by 90° is 1 m to its side afterwards."""
    quarter = Rotation.from_euler("z", [[0], [90]], degrees=True).as_quat(scalar_first=True)
    log = Trajectory(np.array([0.0, 1.0]), np.zeros((2, 3)), quarter)
    mount = Pose(np.eye(3), np.array([1.0, 0, 0]))
    trajectory = PoseLog(log, mount).follow(np.array([0.0, 1.0]), np.array([0.0, 1.0]))
    np.testing.assert_allclose(trajectory.positions, [[1, 0, 0], [0, 1, 0]], atol=1e-12)
