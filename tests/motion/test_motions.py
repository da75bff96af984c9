"""What every motion promises; a new motion joins the list and inherits the tests."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from murkscan.errors import InputError
from murkscan.io.poses import load_poses
from murkscan.motion import ConstantSpeed, ConstantStep, PoseLog
from murkscan.types.pose import Pose
from murkscan.types.trajectory import Trajectory


def straight(times):
    """A log of a vehicle that goes along x at half a metre a second."""
    places = np.outer(0.5 * times, [1.0, 0, 0])
    return Trajectory(times, places, np.tile([1.0, 0, 0, 0], (len(times), 1)))


LOG = straight(np.arange(0, 100.1, 0.25))
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
    with pytest.raises(
        InputError, match=r"covers 0%.*120\.000 to 121\.960.*0\.000 to 100\.000"
    ) as error:
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
    trajectory = PoseLog(log, mount, gap=2.0).follow(np.array([0.0, 1.0]), np.array([0.0, 1.0]))
    np.testing.assert_allclose(trajectory.positions, [[1, 0, 0], [0, 1, 0]], atol=1e-12)


def test_frames_outside_the_log_are_left_out_and_told():
    motion = PoseLog(LOG, start_time=-0.5)
    trajectory = motion.follow(TIMES, PICTURES)
    np.testing.assert_array_equal(trajectory.times, TIMES[TIMES >= 0.5])
    (told,) = motion.remarks(TIMES)
    assert told.startswith("13 of 50 frames lie outside the log")
    assert "0.000 to 0.480 s" in told


def test_a_hole_is_not_bridged_but_its_edges_are_used():
    times = np.concatenate([np.arange(0, 0.81, 0.1), np.arange(1.4, 3, 0.1)])
    motion = PoseLog(straight(times), gap=0.5)
    trajectory = motion.follow(TIMES, PICTURES)
    missing = np.setdiff1d(TIMES, trajectory.times)
    assert missing.min() > 0.8
    assert missing.max() < 1.4
    assert 0.8 in trajectory.times
    (told,) = motion.remarks(TIMES)
    assert told.startswith(f"{len(missing)} of 50 frames lie in holes")
    bridged = PoseLog(straight(times), gap=0.7)
    assert len(bridged.follow(TIMES, PICTURES).times) == 50
    assert bridged.remarks(TIMES) == ()


def test_a_log_that_is_too_coarse_asks_for_the_flag():
    with pytest.raises(InputError, match=r"a pose every 1 s.*--gap-s"):
        PoseLog(straight(np.arange(10.0))).follow(TIMES, PICTURES)


@pytest.mark.parametrize("gap", [0.0, -1.0, np.nan])
def test_a_gap_that_is_none_is_refused(gap):
    with pytest.raises(InputError, match="above 0"):
        PoseLog(LOG, gap=gap)


def test_lost_fixes_are_left_out_and_told_with_their_times(fault):
    true, log = (load_poses(fault(name)) for name in ("recording/poses.csv", "poses/zeros.csv"))
    motion = PoseLog(log)
    trajectory = motion.follow(true.times, np.arange(60.0))
    np.testing.assert_allclose(trajectory.positions, true.positions, atol=1e-12)
    (told,) = motion.remarks(true.times)
    assert "3 poses of the log are left out" in told
    assert "1.200 to 1.240 s, 1.800 s" in told
