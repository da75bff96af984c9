"""An object on a turntable: its points stay where they are in the world that turns with it."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from murkscan.cli.main import run
from murkscan.errors import InputError
from murkscan.io.poses import load_poses
from murkscan.motion import turn_about_axis

POINT, AXIS = np.array([0.02, 0.0, 0.6]), np.array([0.1, 2.0, 0.0])


@pytest.mark.parametrize("rate", [0.4, -0.4, 0.001])
def test_a_point_of_the_object_stays_where_it_is_in_the_world(rate):
    start, unit = np.array([0.1, 0.05, 0.7]), AXIS / np.linalg.norm(AXIS)
    way = turn_about_axis(POINT, AXIS, rate=rate, duration=9.0)
    times = np.linspace(0.0, 9.0, 1234)
    turned = Rotation.from_rotvec(rate * times[:, None] * unit).apply(start - POINT)
    seen = POINT + turned  # by the camera, which stands still
    # The chord between poses 0.1° apart, 0.6 m from the axis: 0.6 m × (0.05°)² / 2 = 0.23 µm.
    np.testing.assert_allclose(way.transform(seen, times) - start, 0.0, atol=2.5e-7)
    assert np.diff(way.times).max() < 0.5  # what scan bridges unless told otherwise


@pytest.mark.parametrize(
    ("axis", "rate", "duration"),
    [(0 * AXIS, 1.0, 1.0), (AXIS, 0.0, 1.0), (AXIS, 1.0, 0.0), (AXIS, 1e9, 1.0)],
)
def test_what_does_not_turn_is_refused(axis, rate, duration):
    with pytest.raises(InputError):
        turn_about_axis(POINT, axis, rate=rate, duration=duration)


def test_steps_and_a_rate_write_the_same_log(tmp_path, capsys):
    one, other = tmp_path / "one.csv", tmp_path / "other.csv"
    place = ["--point-m", "-0.02,0.1,0.6"]
    assert run(["turntable", str(one), *place, "--turn-deg-s", "18", "--seconds", "20"]) == 0
    steps = ["--step-deg", "1.8", "--fps", "10", "--pictures", "200"]
    assert run(["turntable", str(other), *place, *steps]) == 0
    assert one.read_bytes() == other.read_bytes()
    assert load_poses(one).times[-1] == 20
    assert "1.00 turns" in capsys.readouterr().out
    assert run(["turntable", str(one), *place, "--turn-deg-s", "18", "--pictures", "2"]) == 2
