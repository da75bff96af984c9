"""What a vehicle sends is written down, and read at once."""

import math
import time

import numpy as np
import pytest

from murkscan.errors import InputError
from murkscan.io.dive.mavlink_link import MavlinkLink
from murkscan.io.navigation_log import read_navigation_log
from murkscan.motion.following_navigation import NavigationFollower

from ..streams import free_port, stream_rig

mavutil = pytest.importorskip("pymavlink.mavutil", reason="the extra [tlog] is not installed")


def test_what_comes_is_in_the_log_and_known_at_once(tmp_path):
    port, file = free_port(), tmp_path / "capture" / "navigation.tlog"
    link = MavlinkLink(f"127.0.0.1:{port}", file)
    vehicle = mavutil.mavlink_connection(f"udpout:127.0.0.1:{port}", source_system=1)
    began = time.time()
    with link.listening():
        for k in range(20):
            turned = 0.02 * k
            vehicle.mav.attitude_send(40 * k, 0.0, 0.0, turned, 0.0, 0.0, 0.0)
            vehicle.mav.local_position_ned_send(40 * k, 0.01 * k, 0.0, 2.0, 0.0, 0.0, 0.0)
            vehicle.mav.heartbeat_send(0, 0, 0, 0, 0)
            time.sleep(0.02)
        time.sleep(0.3)
        recent = list(link.read_recent())
    vehicle.close()
    ((attitude, position),) = [sorted(some, key=lambda one: one.kind) for some in recent]
    assert (attitude.kind, position.kind) == ("attitude", "position")
    np.testing.assert_allclose(attitude.values[:, 2], 0.02 * np.arange(20), atol=1e-6)
    assert np.all(np.diff(position.times) > 0)
    north = read_navigation_log(file).poses.positions[:, 0]
    assert len(north) >= 20
    assert np.all(np.diff(north) >= 0)
    # The last attitude may have come before the last place, and the first after the first.
    assert north[[0, -1]] == pytest.approx([0.0, 0.19], abs=0.011)
    follower = NavigationFollower(
        link, stream_rig(), speed=None, along="x", crs=None, start_time=began, gap=0.5
    )
    follower.refresh()
    assert 0.3 < follower.known_until < 30.0
    times = np.linspace(0.5, 0.9, 5) * follower.known_until
    way = follower.follow(times, np.zeros(5))
    assert np.all(np.diff(way.positions[:, 0]) > 0)
    assert way.positions[0, 2] == pytest.approx(2.0, abs=1e-6)
    assert math.isclose(np.linalg.norm(way.quaternions[0]), 1.0)


@pytest.mark.parametrize("address", ["14550", "udp", "127.0.0.1:", "127.0.0.1:99999"])
def test_what_is_no_address_is_told(tmp_path, address):
    with pytest.raises(InputError, match="HOST:PORT"):
        MavlinkLink(address, tmp_path / "navigation.tlog")
