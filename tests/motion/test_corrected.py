"""A scan corrects its motion, as far as that is stated and places were seen twice."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from murkscan.io.values import load_value, save_value
from murkscan.motion import ConstantSpeed, PoseLog
from murkscan.motion.adjust.checks import longest_without
from murkscan.motion.corrected import _from_first, correct_motion
from murkscan.motion.correction_words import tell_correction, tell_doubt
from murkscan.motion.measured import by_recording, measure_along_attitude
from murkscan.project import describe
from murkscan.types.measured import Measured
from murkscan.types.navigation import NavigationAccuracy
from murkscan.types.pose import Pose
from murkscan.types.profile import Profile
from murkscan.types.trajectory import Trajectory

from .adjust.test_adjust import SPEED, scan, swing

pytestmark = pytest.mark.without_types


def as_profile(one):
    """Give a pass as the camera saw it that is its vehicle."""
    count = len(one.points)
    ones = np.ones(count, np.float32)
    order = np.lexsort((one.line, one.laser, one.profile))
    return Profile(
        frame=one.profile.astype(np.uint32),
        time=one.times[one.profile],
        laser=one.laser,
        pixels=np.stack([np.zeros(count), one.line.astype(float)], axis=1),
        points=one.points,
        sigma=ones * np.float32(2e-5),
        signal=ones,
        posterior=ones,
        branch=np.zeros(count, np.uint8),
    )[order]


def logged_way(times):
    places = np.stack([SPEED * times, 0 * times, 0 * times], axis=1)
    return Trajectory(times, places, np.tile([1.0, 0, 0, 0], (len(times), 1)))


def measured(one, origin=(0.0, 0.0, 0.0)):
    return Measured(one.navigation, Pose.identity(), is_placed=True, origin=np.array(origin))


@pytest.fixture(scope="module")
def corrected():
    one = scan(1e-3)
    found = correct_motion(
        measured(one, (4e5, 5e6, 0)), [as_profile(one)], logged_way(one.times), ("x", "x")
    )
    return one, found


def test_what_two_lasers_saw_corrects_the_log_in_its_own_world(corrected):
    one, found = corrected
    inner = slice(5, -5)
    off = found.trajectory.positions[inner, 0] - 4e5 - (SPEED * one.times + swing(one.times))[inner]
    # The swing has an RMS of 4.2 mm; coordinates of a map keep their place.
    assert np.std(off) < 1e-3
    assert np.abs(found.trajectory.positions[:, 1] - 5e6).max() < 0.05
    assert found.is_sound
    assert found.num_tiles > 5


def test_it_says_how_far_and_how_sure_and_what_is_open(corrected):
    _, found = corrected
    length = next(one for one in found.sureness if one.name == "length of the way")
    assert length.found < 0.2 * length.logged
    assert not length.is_open
    words = tell_correction(found)
    assert words[0].startswith("corrected from what the scan saw twice, by ")
    assert "length of the way" in words[1]
    # Times of a dive count from 1970: it is told from the scan's own beginning.
    way = found.trajectory
    late = replace(found, trajectory=replace(way, times=way.times + 1.7e9))
    assert tell_correction(late)[0] == words[0]
    doubted = replace(found, blind=3.0)
    assert not doubted.is_sound
    assert "Over 3.0 s" in tell_doubt(doubted)


def test_a_way_without_positions_begins_where_its_log_does():
    one = scan(1e-3)
    summed = replace(one.navigation, position=None)
    logged = logged_way(one.times)
    logged = replace(logged, positions=logged.positions + np.array([3.0, 4.0, 0.0]))
    source = Measured(summed, Pose.identity(), is_placed=True)
    found = correct_motion(source, [as_profile(one)], logged, ("x", "x"))
    np.testing.assert_allclose(found.trajectory.positions[0], logged.positions[0])
    assert found.moved.max() < 0.03


def test_one_laser_on_one_pass_shows_no_place_twice():
    one = scan(1e-3, lasers=1)
    logged = logged_way(one.times)
    assert correct_motion(measured(one), [as_profile(one)], logged, ("x",)) is None


def test_relief_that_lies_on_nothing_is_counted_in_time():
    times, good = np.arange(0, 10, 0.5), np.array([0.0, 1.0, 2.0, 6.0, 7.0, 8.0, 9.0])
    # 0.5 and 1.5 lie alone; 2.5 to 5.5 lie on nothing.
    assert longest_without(times, good) == pytest.approx(3.0)
    assert longest_without(times, times) == 0.0
    assert longest_without(times, np.zeros(0)) == pytest.approx(9.5)


def test_a_way_from_its_first_pose_states_the_same_of_every_length():
    random = np.random.default_rng(3)
    times = np.arange(5.0)
    turns = Rotation.from_rotvec(random.normal(0, 0.3, (5, 3))).as_quat(scalar_first=True)
    way = Trajectory(times, random.normal(size=(5, 3)), turns, 1e-3 * random.normal(size=(5, 6, 4)))
    first = _from_first(way)
    assert np.abs(first.errors[0]).max() < 1e-12
    np.testing.assert_allclose(first.positions[0], 0, atol=1e-12)
    own = random.normal(size=(5, 3))
    along = []
    for one in (way, first):
        points = one.transform(own, times)
        shifts = one.shifts(points, times)
        between = points[3] - points[1]
        along.append(between @ (shifts[3] - shifts[1]))
    np.testing.assert_allclose(along[0], along[1], atol=1e-12)


def test_a_speed_is_measured_along_its_own_axis_and_an_exact_one_is_not_corrected():
    found = ConstantSpeed(-0.2, "y", 0.05).measure()
    assert found.navigation.speed == 0.2
    assert found.navigation.accuracy.speed == 0.05
    np.testing.assert_allclose(found.vehicle_from_camera @ np.array([[0.0, -1, 0]]), [[1, 0, 0]])
    assert np.linalg.det(found.vehicle_from_camera.rotation) == pytest.approx(1)
    assert ConstantSpeed(0.2, "y", 0.0).measure() is None


def test_poses_of_which_nothing_is_stated_are_never_changed():
    way = logged_way(np.arange(0, 3, 0.1))
    assert PoseLog(way).measure() is None
    # How well the vehicle knows its attitude says nothing of where it is.
    assert PoseLog(way, stated=NavigationAccuracy(attitude_noise=1e-3)).measure() is None
    placed = PoseLog(way, stated=NavigationAccuracy(position_noise=0.01), start_time=1.0).measure()
    np.testing.assert_allclose(placed.navigation.position.times, way.times - 1.0)
    # Of a clock of which nothing is stated half a second is taken for granted.
    assert placed.navigation.accuracy.clock_offset == 0.5
    led = PoseLog(way, stated=NavigationAccuracy(velocity_noise=0.01)).measure()
    np.testing.assert_allclose(led.navigation.velocity.values, [[SPEED, 0, 0]] * 29, atol=1e-12)


def test_a_speed_beside_an_attitude_stands_for_velocities_and_places():
    one = scan(1e-3, lasers=1)
    log = measure_along_attitude(one.navigation, np.array([0.0, -0.1, 0.0]), 0.1)
    assert log.speed == pytest.approx(0.1)
    assert log.course == (0.0, -1.0, 0.0)
    assert log.accuracy.speed == 0.1
    assert log.velocity is None
    assert log.position is None
    moved = by_recording(log, 2.0, Pose.identity()).navigation
    assert (moved.speed, moved.course) == (log.speed, log.course)


def test_what_was_measured_is_kept_as_it_was(tmp_path):
    source = measured(scan(1e-3, lasers=1), (4e5, 5e6, 0))
    save_value(tmp_path / "measured.json", source)
    assert describe(load_value(tmp_path / "measured.json", Measured)) == describe(source)
    spoken = ConstantSpeed(-0.2, "y", 0.05).measure()
    save_value(tmp_path / "speed.json", spoken)
    assert describe(load_value(tmp_path / "speed.json", Measured)) == describe(spoken)
