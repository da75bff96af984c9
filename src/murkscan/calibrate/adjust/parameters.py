"""Which of a rig's parameters each calibration estimates."""

import numpy as np

from ...types.laser import Fan, Laser
from ...types.port import FlatPort, Port
from ...types.rig_covariance import RigCovariance

INTRINSICS = (
    *(f"camera.focal_length[{i}]" for i in range(2)),
    *(f"camera.principal_point[{i}]" for i in range(2)),
    *(f"camera.distortion[{i}]" for i in range(5)),
)
"""A camera without its port."""
MOUNT = tuple(f"mount.{part}[{i}]" for part in ("translation", "turn") for i in range(3))
"""Where the camera sits on the vehicle."""


def port_parameters(port: Port) -> tuple[str, ...]:
    """Name what boards tell of a camera's port: how it stands; its glass is as it was measured."""
    if isinstance(port, FlatPort):
        return ("camera.port.normal[0]", "camera.port.normal[1]", "camera.port.distance")
    return tuple(f"camera.port.centre[{i}]" for i in range(3))


def sheet_parameters(laser: Laser, number: int) -> tuple[str, ...]:
    """Name what stripes tell of a laser's sheet.

    A flat sheet has a normal and a distance. A fan is moved along its normal and turned about its
    direction and its tangent; turning it about its normal, or moving it within its own plane, does
    not move a flat sheet.
    """
    key = f"laser[{number}]"
    if not isinstance(laser.sheet, Fan):
        return (f"{key}.normal[0]", f"{key}.normal[1]", f"{key}.distance")
    return (f"{key}.shift[2]", f"{key}.turn[0]", f"{key}.turn[1]")


def window_parameters(laser: Laser, number: int) -> tuple[str, ...]:
    """Name what decides how a fan bends at its flat port: where it starts, and how the port stands.

    None where the sheet is flat, or the port a dome.
    """
    if not isinstance(laser.sheet, Fan) or not isinstance(laser.sheet.port, FlatPort):
        return ()
    key = f"laser[{number}]"
    port = (f"{key}.port.normal[0]", f"{key}.port.normal[1]", f"{key}.port.distance")
    return (f"{key}.shift[0]", f"{key}.shift[1]", *port)


def window_prior(
    laser: Laser,
    number: int,
    *,
    origin_sigma: float = 2e-3,
    tilt_sigma: float = float(np.radians(1.0)),
    distance_sigma: float = 1e-3,
) -> RigCovariance:
    """Say how well a fan's origin and port were measured; stripes tell little of them.

    Args:
        laser: The laser as it was measured.
        number: Its number.
        origin_sigma: Standard deviation of where the fan starts, within its plane [m].
        tilt_sigma: That of the direction of its port [rad].
        distance_sigma: That of the port's distance from the origin [m].
    """
    names = window_parameters(laser, number)
    sigma = [origin_sigma] * 2 + [tilt_sigma] * 2 + [distance_sigma]
    return RigCovariance(names, np.diag(np.square(sigma[: len(names)])))
