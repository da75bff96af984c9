"""Poses of a camera that is under way are those that are known afterwards."""

import math

import numpy as np
import pytest

from murkscan.errors import FormatError
from murkscan.io.growing_table import GrowingTable
from murkscan.io.pose_reading import PoseConvention
from murkscan.motion import ConstantSpeed, ConstantStep, PoseLog
from murkscan.motion.following import LogFollower, SteadyFollower, is_clock
from murkscan.types.pose import Pose
from murkscan.types.trajectory import Trajectory

HEAD = "time_s,x_m,y_m,z_m,qw,qx,qy,qz\n"
MOUNT = Pose(np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]]), np.array([0.1, 0.0, 0.2]))


@pytest.mark.parametrize("motion", [ConstantSpeed(0.1, "y"), ConstantStep(0.004, "x")])
def test_a_steady_camera_is_where_its_scan_will_have_it(motion):
    times = np.arange(10) * 0.04 + 3.0
    whole = motion.follow(times, np.arange(10.0))
    follower = SteadyFollower(motion)
    parts = [follower.follow(times[k : k + 3], np.arange(10.0)[k : k + 3]) for k in (0, 3, 6, 9)]
    np.testing.assert_allclose(
        np.concatenate([part.positions for part in parts]), whole.positions, atol=1e-12
    )
    assert follower.known_until == math.inf
    assert follower.follow(np.zeros(0), np.zeros(0)) is None


def line(time):
    turn = np.array([math.cos(time / 9), 0.0, 0.0, math.sin(time / 9)])
    return (
        ",".join(map(repr, map(float, [1000 + time, 0.1 * time, 0.02 * time**2, 0, *turn]))) + "\n"
    )


def test_a_log_that_grows_is_followed_as_the_whole_log_will_be(tmp_path):
    file = tmp_path / "poses.csv"
    file.write_text(HEAD + line(0.0))
    table = GrowingTable(file, "pose log")
    follower = LogFollower(table, PoseConvention(), MOUNT, start_time=1000.0, gap=0.5)
    follower.refresh()
    assert follower.follow(np.array([0.1]), np.zeros(1)) is None
    found, wanted = [], []
    for second in range(1, 4):
        with file.open("a") as log:
            new = "".join(line(second - 1 + k / 10) for k in range(1, 11))
            log.write(new[:-5])
            log.flush()
            follower.refresh()  # the last line is only half there
            log.write(new[-5:])
        follower.refresh()
        assert follower.known_until == pytest.approx(second)
        times = np.linspace(second - 0.9, second - 0.1, 5)
        wanted.append(times)
        found.append(follower.follow(times, np.zeros(5)))
    stamps = np.arange(31) / 10
    log = np.array([[float(v) for v in line(t).split(",")] for t in stamps])
    whole = PoseLog(Trajectory(log[:, 0], log[:, 1:4], log[:, 4:]), MOUNT, 1000.0)
    same = whole.follow(np.concatenate(wanted), np.zeros(15))
    np.testing.assert_allclose(np.concatenate([one.positions for one in found]), same.positions)
    np.testing.assert_allclose(np.concatenate([one.quaternions for one in found]), same.quaternions)


def test_a_hole_in_the_log_is_not_bridged_and_the_future_is_not_known(tmp_path):
    file = tmp_path / "poses.csv"
    file.write_text(HEAD + "".join(map(line, (0.0, 0.1, 2.0, 2.1))))
    follower = LogFollower(
        GrowingTable(file, "pose log"),
        PoseConvention(),
        Pose.identity(),
        start_time=1000.0,
        gap=0.5,
    )
    follower.refresh()
    poses = follower.follow(np.array([0.05, 1.0, 2.05, 2.2]), np.zeros(4))
    assert poses.times.tolist() == [0.05, 2.05]


def test_a_clock_is_told_from_a_recordings_time(tmp_path):
    file = tmp_path / "poses.csv"
    table = GrowingTable(file, "pose log")
    with pytest.raises(FormatError, match=r"poses\.csv cannot be read"):
        is_clock(table, PoseConvention())
    file.write_text(HEAD)
    with pytest.raises(FormatError, match="holds no pose yet"):
        is_clock(table, PoseConvention())
    file.write_text(HEAD + line(0.0))
    assert not is_clock(table, PoseConvention())
    file.write_text(HEAD + "1.7e9,0,0,0,1,0,0,0\n")
    assert is_clock(table, PoseConvention())
    assert table.read_new().rows  # nothing is lost by having looked
