"""Pose logs, CSV and TUM."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from murkscan.errors import FormatError
from murkscan.io.poses import load_poses, save_poses
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
        (CSV + "1.0,1,2\n", "line 4"),
        (CSV + "1.0,1,2,x,1,0,0,0\n", "line 4"),
        (CSV + "1.0,1,2,nan,1,0,0,0\n", "line 4"),
        (CSV + "1.0,1,2,3,0,0,0,0\n", "line 4"),
        (CSV + "0.1,1,2,3,1,0,0,0\n", "increase"),
        ("hello\n", "line 1"),
    ],
)
def test_a_wrong_log_names_the_file_and_the_line(tmp_path, text, says):
    path = tmp_path / "poses.csv"
    path.write_text(text)
    with pytest.raises(FormatError, match=says) as error:
        load_poses(path)
    assert str(path) in str(error.value)


@pytest.mark.parametrize("name", ["bus_outside", "cave", "cemetery"])
def test_real_underwater_tracks_are_read(data, name):
    log = load_poses(data("underwater_trajectories") / f"{name}.txt")
    assert len(log.times) > 100
