"""Poses and trajectories obey the axioms of rigid motions."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from murkscan.errors import InputError
from murkscan.types.pose import Pose
from murkscan.types.trajectory import Trajectory

numbers = st.floats(-2, 2)
quaternions = st.tuples(numbers, numbers, numbers, numbers).filter(lambda q: sum(map(abs, q)) > 0.1)
poses = st.builds(
    lambda q, t: Pose.from_quaternion(np.array([q]), np.array(t)),
    quaternions,
    st.tuples(numbers, numbers, numbers),
)


@given(poses, poses, poses)
def test_composition_is_associative(a, b, c):
    left, right = (a @ b) @ c, a @ (b @ c)
    np.testing.assert_allclose(left.rotation, right.rotation, atol=1e-12)
    np.testing.assert_allclose(left.translation, right.translation, atol=1e-12)


@given(poses)
def test_a_pose_after_its_inverse_moves_nothing(pose):
    still = pose @ pose.inverse()
    np.testing.assert_allclose(still.rotation, np.eye(3), atol=1e-12)
    np.testing.assert_allclose(still.translation, 0, atol=1e-12)


@given(poses)
def test_a_quaternion_there_and_back_is_the_same_pose(pose):
    again = Pose.from_quaternion(pose.as_quaternion(), pose.translation)
    np.testing.assert_allclose(again.rotation, pose.rotation, atol=1e-12)


def _turning():
    """A quarter turn about z in 1 s while moving 2 m along x."""
    ends = Rotation.from_euler("z", [[0], [90]], degrees=True).as_quat(scalar_first=True)
    return Trajectory(np.array([10.0, 11.0]), np.array([[0.0, 0, 0], [2, 0, 0]]), ends)


def test_attitude_turns_evenly_and_position_moves_evenly():
    half = _turning().at(np.array([10.5]))
    angle = Rotation.from_quat(half.quaternions, scalar_first=True).as_euler("zyx", degrees=True)
    np.testing.assert_allclose(angle, [[45, 0, 0]], atol=1e-12)
    np.testing.assert_allclose(half.positions, [[1, 0, 0]], atol=1e-12)


def test_points_move_by_the_pose_of_their_own_time():
    points, times = np.array([[1.0, 0, 0], [1.0, 0, 0]]), np.array([11.0, 10.0])
    moved = _turning().transform(points, times)
    np.testing.assert_allclose(moved, [[2, 1, 0], [1, 0, 0]], atol=1e-12)


def test_a_time_outside_the_log_is_refused():
    with pytest.raises(InputError, match=r"10\.000 to 11\.000"):
        _turning().at(np.array([9.0, 10.5]))


def test_times_that_stand_still_are_refused():
    with pytest.raises(InputError, match="increasing"):
        Trajectory(np.zeros(2), np.zeros((2, 3)), np.tile([1.0, 0, 0, 0], (2, 1)))


@given(poses, poses)
def test_a_mount_is_the_composition_with_it(vehicle, mount):
    log = Trajectory(np.zeros(1), vehicle.translation[None], vehicle.as_quaternion())
    camera = log.follow_mount(mount)
    composed = vehicle @ mount
    np.testing.assert_allclose(camera.positions[0], composed.translation, atol=1e-12)
    again = Pose.from_quaternion(camera.quaternions, camera.positions[0])
    np.testing.assert_allclose(again.rotation, composed.rotation, atol=1e-12)
