"""Which of a rig's parameters each calibration estimates."""

from ..types.laser import Fan, Laser
from ..types.port import FlatPort, Port

INTRINSICS = (
    *(f"camera.focal_length[{i}]" for i in range(2)),
    *(f"camera.principal_point[{i}]" for i in range(2)),
    *(f"camera.distortion[{i}]" for i in range(5)),
)
"""A camera without its port."""


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


def laser_port_parameters(laser: Laser, number: int) -> tuple[str, ...]:
    """Name how a fan's port stands; none where it has none, or a dome."""
    if not isinstance(laser.sheet, Fan) or not isinstance(laser.sheet.port, FlatPort):
        return ()
    key = f"laser[{number}].port"
    return (f"{key}.normal[0]", f"{key}.normal[1]", f"{key}.distance")
