"""Pose logs, CSV and TUM."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.spatial.transform import Rotation

from murkscan.errors import FormatError, InputError
from murkscan.io.pose_reading import PoseConvention
from murkscan.io.poses import load_poses, read_pose_log, save_poses
from murkscan.types.trajectory import Trajectory

CSV = "time_s,x_m,y_m,z_m,qw,qx,qy,qz\n0.0,1,2,3,1,0,0,0\n0.5,1,2,4,0,1,0,0\n"
TUM = "# a comment\n0.0 1 2 3 0 0 0 1\n0.5 1 2 4 1 0 0 0\n"


@given(arrays(float, (5, 3), elements=st.floats(-1e6, 1e6)))
def test_a_log_there_and_back_is_the_same_to_the_last_bit(tmp_path_factory, positions):
    path = tmp_path_factory.mktemp("poses") / "poses.csv"
    upright = np.tile([1.0, 0, 0, 0], (5, 1))
    log = Trajectory(np.arange(5) / 3, positions, upright)
    save_poses(path, log)
    again = load_poses(path)
    np.testing.assert_array_equal(again.times, log.times)
    np.testing.assert_array_equal(again.positions, log.positions)
    np.testing.assert_array_equal(again.quaternions, log.quaternions)


@pytest.mark.parametrize("text", [CSV, TUM])
def test_both_forms_say_the_same(tmp_path, text):
    path = tmp_path / "poses.txt"
    path.write_text(text)
    log = load_poses(path)
    np.testing.assert_array_equal(log.times, [0, 0.5])
    np.testing.assert_array_equal(log.positions[1], [1, 2, 4])
    np.testing.assert_array_equal(log.quaternions, [[1, 0, 0, 0], [0, 1, 0, 0]])


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "holds no poses"),
        (CSV.replace("qz", "q"), "column qz"),
        (CSV + "1.0,1,2\n1.5,1,2,3,1,0,0,0\n", "line 4"),
        (CSV + "1.0,1,2,x,1,0,0,0\n", "line 4"),
        (CSV + "0.1,1,2,3,1,0,0,0\n", "line 4: the times of the poses do not increase"),
        (CSV.replace("x_m", "x [furlong]"), "a unit that is not known"),
        (CSV.replace("time_s", "time").replace("0.5", "half past nine"), "line 3"),
        ("hello\n", "holds no poses"),
        ("hello world 1\n", "line 1"),
        ("a\0b", "is no text"),
    ],
)
def test_a_wrong_log_names_the_file_and_the_line(tmp_path, text, says):
    path = tmp_path / "poses.csv"
    path.write_text(text)
    with pytest.raises(FormatError, match=says) as error:
        load_poses(path)
    assert str(path) in str(error.value)


@pytest.mark.parametrize(
    ("line", "why"),
    [
        ("1.0,1,2,nan,1,0,0,0\n", "no finite time and place"),
        ("1.0,1,2,1e20,1,0,0,0\n", "no finite time and place"),
        ("1.0,1,2,3,0,0,0,0\n", "a quaternion whose length is not 1"),
        ("0.5,1,2,4,0,1,0,0\n", "a repeated pose"),
        ("1.0,1,2", "cut off"),
    ],
)
def test_a_line_that_gives_no_pose_is_left_out_with_a_word(tmp_path, line, why):
    path = tmp_path / "poses.csv"
    path.write_text(CSV + line)
    read = read_pose_log(path)
    assert read.left_out == ((4, why),)
    with pytest.warns(UserWarning, match=r"1 lines are left out \(4\): " + why):
        np.testing.assert_array_equal(load_poses(path).times, [0, 0.5])


LOGS = {
    "euroc.csv": ("nanoseconds, from 2021-07-01T12:00:00.000Z", "quaternions wxyz"),
    "ros_odom.csv": ("nanoseconds, from 2021-07-01T12:00:00.000Z", "quaternions xyzw"),
    "tum_commas.txt": ("seconds, from 0.000 s", "quaternions xyzw"),
    "tum_ns.txt": ("nanoseconds, from 2021-07-01", "quaternions xyzw"),
    "iso.csv": ("times as dates", "quaternions wxyz"),
    "excel_de.csv": ("seconds, from 0.000 s", "quaternions wxyz"),
    "tum_twice.txt": ("seconds, from 0.000 s", "quaternions xyzw"),
    "rov_nav.csv": ("positions north, east, down (NED)", "roll, pitch, heading in degrees, NED"),
}


@pytest.mark.parametrize("name", LOGS)
def test_a_log_as_others_write_it_gives_the_same_poses(fault, name):
    true, read = load_poses(fault("recording/poses.csv")), read_pose_log(fault(f"poses/{name}"))
    began = 0.0 if read.log.times[0] < 1e8 else 1625140800.0
    # Seconds since 1970 have steps of 2.4e-7 s in double precision.
    np.testing.assert_allclose(read.log.times - began, true.times, rtol=0, atol=2.4e-7)
    np.testing.assert_allclose(read.log.positions, true.positions, rtol=0, atol=1e-12)
    np.testing.assert_allclose(read.log.quaternions, true.quaternions, rtol=0, atol=1e-12)
    assert all(words in read.understood for words in LOGS[name])
    assert len(read.left_out) == (name == "tum_twice.txt")


NAV = "time,north (m),east (m),depth (m),roll,pitch,heading\n1,1,2,3,{}\n2,1,2,3,{}\n"


def test_angles_turn_by_heading_then_pitch_then_roll_in_the_axes_that_are_said(tmp_path):
    """Fossen, Handbook of Marine Craft, 2011, equation 2.18: NED from body is Rz Ry Rx."""
    path = tmp_path / "nav.csv"
    path.write_text(NAV.format("10,20,30", "0,0,90"))
    r, p, h = np.radians([10, 20, 30])
    rx = np.array([[1, 0, 0], [0, np.cos(r), -np.sin(r)], [0, np.sin(r), np.cos(r)]])
    ry = np.array([[np.cos(p), 0, np.sin(p)], [0, 1, 0], [-np.sin(p), 0, np.cos(p)]])
    rz = np.array([[np.cos(h), -np.sin(h), 0], [np.sin(h), np.cos(h), 0], [0, 0, 1]])
    log = read_pose_log(path).log
    first = Rotation.from_quat(log.quaternions[0], scalar_first=True).as_matrix()
    np.testing.assert_allclose(first, rz @ ry @ rx, atol=1e-12)
    # A vehicle that heads east looks along y of north-east-down.
    east = Rotation.from_quat(log.quaternions[1], scalar_first=True).apply([1, 0, 0])
    np.testing.assert_allclose(east, [0, 1, 0], atol=1e-12)
    np.testing.assert_array_equal(log.positions[0], [1, 2, 3])
    enu = read_pose_log(path, PoseConvention(axes="enu")).log
    np.testing.assert_array_equal(enu.positions[0], [2, 1, -3])


def test_what_a_log_does_not_say_can_be_said(tmp_path):
    path = tmp_path / "nav.csv"
    path.write_text(NAV.format("0.1,0.2,0.3", "0,0,1.5"))
    assert "degrees (the file does not say)" in read_pose_log(path).understood
    said = read_pose_log(path, PoseConvention(angles="rad", time_unit="ms"))
    turn = Rotation.from_quat(said.log.quaternions[1], scalar_first=True).magnitude()
    assert turn == pytest.approx(1.5)
    np.testing.assert_allclose(said.log.times, [0.001, 0.002])
    path.write_text("0 1 2 3 1 0 0 0\n1 1 2 3 1 0 0 0\n")
    first = read_pose_log(path, PoseConvention(quaternion="wxyz")).log.quaternions[0]
    np.testing.assert_array_equal(first, [1, 0, 0, 0])


@pytest.mark.parametrize(
    ("text", "convention"),
    [
        (CSV, PoseConvention(quaternion="wxyz")),
        (CSV, PoseConvention(axes="ned")),
        (TUM, PoseConvention(angles="deg")),
        (NAV.format("0,0,350", "0,0,0"), PoseConvention(angles="rad")),
    ],
)
def test_a_convention_that_says_nothing_of_the_log_is_refused(tmp_path, text, convention):
    path = tmp_path / "poses.csv"
    path.write_text(text)
    with pytest.raises(InputError):
        read_pose_log(path, convention)


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "latin-1"])
def test_a_spreadsheet_is_read_in_its_alphabet(tmp_path, encoding):
    path = tmp_path / "poses.csv"
    text = CSV.replace("x_m", "x (m)") + "# Südsee\n"
    path.write_text(text.replace(",", "\t"), encoding)
    assert len(read_pose_log(path).log.times) == 2


@pytest.mark.parametrize("name", ["bus_outside", "cave", "cemetery"])
def test_real_underwater_tracks_are_read(data, name):
    log = load_poses(data("underwater_trajectories") / f"{name}.txt")
    assert len(log.times) > 100
