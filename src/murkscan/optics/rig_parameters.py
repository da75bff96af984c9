"""A rig's parameters by name, and the rig that differs from another by small changes of them."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import scipy

from ..errors import InputError
from ..types.arrays import Matrix3, Scalars, Vector
from ..types.camera import Camera
from ..types.laser import Fan, Laser
from ..types.plane import Plane
from ..types.port import DomePort, FlatPort, Layer, Port
from ..types.pose import Pose
from ..types.rig import Rig
from ..types.water import Water
from .water import refractive_index

_ALONG_X = 0.9
"""Component along x from which a normal tilts towards y and z rather than x and y."""


def perturb_rig(rig: Rig, names: Sequence[str], changes: Scalars) -> Rig:
    """Give the rig that differs by small changes of some of its parameters.

    Most names are keys of rig.toml, with a number for the component: `camera.focal_length[0]`
    [px], `camera.distortion[4]`, `camera.port.distance` [m], `camera.port.layer[0].index`,
    `camera.port.centre[2]` [m], `laser[0].distance` [m], `water.index`. Directions have as many
    parameters as they can turn in:

    - `….normal[0]`, `….normal[1]` tilt a normal [rad] towards the two directions of
      `tilt_directions`: towards the camera's x and y for a port that faces the camera;
    - `laser[0].shift[0…2]` [m] and `laser[0].turn[0…2]` [rad] move a fan's origin along, and turn
      the fan about, its own direction, tangent and normal; its port keeps its normal and its
      distance from the origin;
    - `mount.translation[0…2]` [m] is along the vehicle's axes, `mount.turn[0…2]` [rad] about the
      camera's.

    Args:
        rig: The rig to start from.
        names: Which parameters.
        changes: What to add to each; px, m, rad or no unit.

    Raises:
        InputError: The rig has no such parameter, or cannot have that value.
    """
    pending = _Changes(dict(zip(names, changes.tolist(), strict=True)))
    changed = _perturb(rig, pending)
    if pending.left:
        raise InputError(
            f"The rig has no parameter {', '.join(pending.left)}; it has "
            f"{', '.join(parameters_of(rig))}."
        )
    return changed


def parameters_of(rig: Rig) -> tuple[str, ...]:
    """Name every parameter that a rig has, in the order of rig.toml."""
    nothing = _Changes({})
    _perturb(rig, nothing)
    return tuple(nothing.asked)


def tilt_directions(normal: Vector) -> tuple[Vector, Vector]:
    """Give the two unit directions towards which a normal tilts.

    The first is the camera's x made perpendicular to the normal, or its y where the normal itself
    lies along x; the second is normal × first.
    """
    axis = np.eye(3)[0 if abs(normal[0]) < _ALONG_X else 1]
    first = axis - (axis @ normal) * normal
    first /= np.linalg.norm(first)
    return first, np.cross(normal, first)


class _Changes:
    """Changes that are still to be made, and the names that were asked for."""

    def __init__(self, left: dict[str, float]) -> None:
        self.left, self.asked = left, list[str]()

    def one(self, name: str) -> float:
        self.asked.append(name)
        return self.left.pop(name, 0.0)

    def many(self, name: str, count: int) -> Scalars:
        return np.array([self.one(f"{name}[{i}]") for i in range(count)])


def _perturb(rig: Rig, changes: _Changes) -> Rig:
    camera = _perturb_camera(rig.camera, changes)
    lasers = tuple(
        _perturb_laser(laser, f"laser[{number}]", changes)
        for number, laser in enumerate(rig.lasers)
    )
    water, mount = rig.water, rig.vehicle_from_camera
    if water is not None:
        water = _perturb_water(water, rig.wavelength, changes)
    if mount is not None:
        shift, turn = changes.many("mount.translation", 3), changes.many("mount.turn", 3)
        mount = Pose(mount.rotation @ _rotation(turn), mount.translation + shift)
    return replace(rig, camera=camera, lasers=lasers, water=water, vehicle_from_camera=mount)


def _perturb_camera(camera: Camera, changes: _Changes) -> Camera:
    fx, fy = camera.focal_length + changes.many("camera.focal_length", 2)
    cx, cy = camera.principal_point + changes.many("camera.principal_point", 2)
    distortion = camera.distortion + changes.many("camera.distortion", 5)
    port = _perturb_port(camera.port, "camera.port", changes)
    return Camera(camera.size, (float(fx), float(fy)), (float(cx), float(cy)), distortion, port)


def _perturb_port(port: Port | None, key: str, changes: _Changes) -> Port | None:
    if port is None:
        return None
    if isinstance(port, FlatPort):
        normal = _tilt(port.normal, changes.many(f"{key}.normal", 2))
        distance = port.distance + changes.one(f"{key}.distance")
        layers = tuple(
            Layer(
                layer.thickness + changes.one(f"{key}.layer[{number}].thickness"),
                layer.index + changes.one(f"{key}.layer[{number}].index"),
            )
            for number, layer in enumerate(port.layers)
        )
        return FlatPort(normal, distance, layers)
    return DomePort(
        port.centre + changes.many(f"{key}.centre", 3),
        port.radius + changes.one(f"{key}.radius"),
        port.thickness + changes.one(f"{key}.thickness"),
        port.index + changes.one(f"{key}.index"),
    )


def _perturb_laser(laser: Laser, key: str, changes: _Changes) -> Laser:
    sheet = laser.sheet
    if isinstance(sheet, Plane):
        normal = _tilt(sheet.normal, changes.many(f"{key}.normal", 2))
        return Laser(Plane(normal, sheet.distance + changes.one(f"{key}.distance")), laser.axis)
    axes = np.stack([sheet.direction, sheet.tangent, sheet.plane.normal], axis=1)
    origin = sheet.origin + axes @ changes.many(f"{key}.shift", 3)
    direction, tangent, _ = (axes @ _rotation(changes.many(f"{key}.turn", 3))).T
    port = _perturb_port(sheet.port, f"{key}.port", changes)
    fan = Fan(origin, direction.copy(), tangent.copy(), sheet.half_angle, port)
    return Laser(fan, laser.axis)


def _perturb_water(water: Water, wavelength: float, changes: _Changes) -> Water:
    change = changes.one("water.index")
    return water if change == 0 else Water(index=refractive_index(water, wavelength) + change)


def _tilt(normal: Vector, angles: Scalars) -> Vector:
    """Turn a normal by a small angle towards each of its tilt directions."""
    angle = float(np.hypot(*angles))
    if angle == 0:
        return normal
    first, second = tilt_directions(normal)
    towards = (angles[0] * first + angles[1] * second) / angle
    return np.cos(angle) * normal + np.sin(angle) * towards


def _rotation(turn: Vector) -> Matrix3:
    return scipy.spatial.transform.Rotation.from_rotvec(turn).as_matrix()
