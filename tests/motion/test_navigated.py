"""What a vehicle's log says of its way, with and without a speed beside it."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from murkscan.errors import InputError
from murkscan.motion import ConstantSpeed, PoseLog
from murkscan.motion.navigated import follow_navigation
from murkscan.types.pose import Pose

from ..scenes import air_rig

TIMES = np.arange(0, 5, 0.1)


@pytest.fixture
def log(tmp_path):
    """Write the columns that are named: a vehicle that heads east, 3 m deep, at 0.2 m/s."""
    values = {
        "time_s": TIMES, "roll_deg": 0 * TIMES, "pitch_deg": 0 * TIMES,
        "heading_deg": 90 + 0 * TIMES, "depth_m": 3 + 0 * TIMES,
        "north_m": 0 * TIMES, "east_m": 0.2 * TIMES,
    }  # fmt: skip

    def write(*names: str):
        rows = np.column_stack([values[name] for name in ("time_s", *names)]).tolist()
        lines = [",".join(("time_s", *names)), *(",".join(map(repr, row)) for row in rows)]
        (tmp_path / "log.csv").write_text("\n".join(lines) + "\n")
        return tmp_path / "log.csv"

    return write


ATTITUDE = ("roll_deg", "pitch_deg", "heading_deg", "depth_m")
RIG = replace(
    air_rig(),
    # The camera looks down, its x to starboard, its y aft: − y is the vehicle's forward.
    vehicle_from_camera=Pose(
        np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]]), np.array([0.3, 0.0, 0.0])
    ),
)


def test_a_speed_goes_along_the_camera_s_axis_as_the_vehicle_heads(log):
    motion, _ = follow_navigation(log(*ATTITUDE), RIG, speed=-0.1, along="y")
    way = motion.follow(TIMES, TIMES)
    moved = way.positions[-1] - way.positions[0]
    np.testing.assert_allclose(moved, [0, 0.1 * TIMES[-1], 0], atol=1e-9)
    np.testing.assert_allclose(way.positions[:, 2], 3, atol=1e-9)
    forward = Rotation.from_quat(way.quaternions, scalar_first=True).apply([0.0, -1, 0])
    np.testing.assert_allclose(forward, np.tile([0.0, 1, 0], (len(TIMES), 1)), atol=1e-9)


def test_a_log_without_a_way_asks_for_a_speed(log):
    with pytest.raises(InputError, match="--speed-mm-s"):
        follow_navigation(log(*ATTITUDE), RIG, speed=None, along="y")
    with pytest.raises(InputError, match="--speed-mm-s"):
        follow_navigation(log("depth_m"), RIG, speed=None, along="y")


def test_places_in_the_log_are_followed_unless_a_speed_is_given(log):
    path = log(*ATTITUDE, "north_m", "east_m")
    motion, said = follow_navigation(path, RIG, speed=None, along="y")
    assert isinstance(motion, PoseLog)
    np.testing.assert_allclose(motion.log.positions[:, 1], 0.2 * TIMES, atol=1e-12)
    motion, said = follow_navigation(path, RIG, speed=-0.1, along="y")
    assert any("not used" in words for words in said)
    np.testing.assert_allclose(motion.log.positions[:, 1], 0.1 * TIMES, atol=1e-9)


def test_a_speed_without_an_attitude_goes_straight_on(log):
    motion, said = follow_navigation(log("depth_m"), RIG, speed=0.1, along="y")
    assert motion == ConstantSpeed(0.1, "y")
    assert any("straight on" in words for words in said)
