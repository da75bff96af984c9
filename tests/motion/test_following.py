"""Poses of a camera that is under way are those that are known afterwards."""

import math

import numpy as np
import pytest

from murkscan.errors import FormatError
from murkscan.io.growing_table import GrowingTable
from murkscan.io.pose_reading import PoseConvention, read_poses
from murkscan.motion import ConstantSpeed, ConstantStep, PoseLog
from murkscan.motion.following import LogFollower, SteadyFollower, is_clock
from murkscan.motion.following_navigation import NavigationFollower, TableReadings
from murkscan.motion.navigated import follow_navigation
from murkscan.types.pose import Pose
from murkscan.types.trajectory import Trajectory

from ..streams import stream_rig

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

    def begin(rows):
        return read_poses(file, rows, PoseConvention()).log.times[0]

    with pytest.raises(FormatError, match=r"poses\.csv cannot be read"):
        is_clock(table, begin)
    file.write_text(HEAD)
    with pytest.raises(FormatError, match="holds nothing yet"):
        is_clock(table, begin)
    file.write_text(HEAD + line(0.0))
    assert not is_clock(table, begin)
    file.write_text(HEAD + "1.7e9,0,0,0,1,0,0,0\n")
    assert is_clock(table, begin)
    assert table.read_new().rows  # nothing is lost by having looked


def measured(time):
    roll, pitch, heading = 2 * math.sin(time), 3 * math.cos(time), 10 + 2 * time
    depth = 4 + 0.1 * math.sin(time / 2)
    return [time, roll, pitch, heading, depth, 0.3 + 0.05 * math.sin(time), 0.02, 0.0]


@pytest.mark.parametrize(("speed", "columns"), [(0.1, 4), (None, 8), (0.1, 5), (None, None)])
def test_a_log_of_measurements_is_followed_as_the_whole_log_will_be(tmp_path, speed, columns):
    """Attitude with a speed, with measured velocities and depth, with depth; and places."""
    names = [
        "time_s",
        "roll_deg",
        "pitch_deg",
        "heading_deg",
        "depth_m",
        "vx_m_s",
        "vy_m_s",
        "vz_m_s",
    ]
    if columns is None:
        names, columns = [*names[:5], "north_m", "east_m"], 7
    file, rig = tmp_path / "navigation.csv", stream_rig()
    file.write_text(",".join(names[:columns]) + "\n")
    settings = {"speed": speed, "along": "x", "crs": None, "gap": 0.5, "start_time": 0.0}
    follower = NavigationFollower(TableReadings(file), rig, **settings)
    found = []
    for second in range(40):
        with file.open("a") as log:
            for k in range(10):
                numbers = measured(second + k / 10)[:columns]
                log.write(",".join(repr(float(number)) for number in numbers) + "\n")
        follower.refresh()
        found.append(follower.follow(np.arange(8) / 10 + second, np.zeros(8)))
    times = np.concatenate([one.times for one in found])
    motion, _ = follow_navigation(file, rig, speed=speed, along="x")
    whole = motion.follow(times, np.zeros(len(times)))
    places = np.concatenate([one.positions for one in found])
    # A depth is smoothed over 0.3 s, of which a log that grows has one side only.
    tolerance = [1e-9, 1e-9, 0.02 if "depth_m" in names[:columns] else 1e-9]
    assert np.all(np.abs(places - whole.positions) < tolerance)
    turns = np.concatenate([one.quaternions for one in found])
    np.testing.assert_allclose(turns, whole.quaternions, atol=1e-9)
