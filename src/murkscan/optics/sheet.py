"""The laser's sheet of light, flat or refracted: where rays meet it and where points lie."""

import math

import numpy as np

from .._kernels.fan import Fan as FanArrays
from .._kernels.fan import locate_points, meet_fan, trace_fan_rays
from ..geometry.intersect import intersect_rays_with_plane
from ..geometry.plane_fit import fit_plane
from ..types.arrays import Points, Scalars, Vector
from ..types.laser import Fan, FanCoordinates, Laser
from ..types.plane import Plane
from ..types.rays import Rays
from .interfaces import as_triple, interfaces_of

_HALF_ANGLE = math.radians(45)
"""Half the opening of a laser that is given as a plane and tells none [rad]."""
_NUM_ANGLES, _NUM_DEPTHS = 301, 18
"""Grid of points to which the equivalent plane is fitted."""


def intersect_rays_with_sheet(rays: Rays, laser: Laser, index: float | None = None) -> Points:
    """Find where each ray meets a laser's sheet.

    Args:
        rays: The rays, in the camera frame.
        laser: The laser.
        index: Refractive index of what lies outside the laser's port; of no effect without one.

    Returns:
        The meeting points [m]; row i belongs to ray i, and is NaN where ray i does not meet the
        sheet in front of its origin, or not within the fan's half angle. A ray that meets a
        refracted sheet twice gives the nearer point.

    Raises:
        Degenerate: There are rays, and every one is parallel to a flat sheet.
        InputError: The laser has a port, but no index is given.
    """
    sheet = laser.sheet
    if isinstance(sheet, Plane):
        return intersect_rays_with_plane(rays, sheet)
    if sheet.port is None:
        return _keep_lit(sheet, intersect_rays_with_plane(rays, sheet.plane))
    arrays, interfaces = _as_arrays(sheet), interfaces_of(sheet.port, index)
    return meet_fan(rays.origins, rays.directions, arrays, interfaces)


def distance_to_sheet(points: Points, laser: Laser, index: float | None = None) -> Scalars:
    """Give the signed distance of each point [m] from a laser's sheet, in the camera frame.

    The sheet is taken to go on beyond a fan's half angle. Positive is the side of the normal of
    the sheet's plane, for a fan direction × tangent; NaN within a fan's port or behind it.

    Raises:
        InputError: The laser has a port, but no index is given.
    """
    sheet = laser.sheet
    if isinstance(sheet, Plane) or sheet.port is None:
        return laser.as_plane().distance_to(points)
    return locate_on_fan(points, sheet, index).distance


def trace_fan(fan: Fan, angles: Scalars, index: float | None = None) -> Rays:
    """Follow the rays of a fan.

    Args:
        fan: The fan.
        angles: Angle of each ray from the middle one, towards the tangent, in the housing [rad].
        index: Refractive index of what lies outside the fan's port; of no effect without one.

    Returns:
        The rays in the camera frame; with a port they start on its outer face.

    Raises:
        InputError: The fan has a port, but no index is given.
    """
    return Rays(*trace_fan_rays(np.tan(angles), _as_arrays(fan), interfaces_of(fan.port, index)))


def locate_on_fan(points: Points, fan: Fan, index: float | None = None) -> FanCoordinates:
    """Find the ray of a fan that passes nearest each point, and where along it and how far off.

    Args:
        points: Points in the camera frame [m].
        fan: The fan, which is taken to go on beyond its half angle.
        index: Refractive index of what lies outside the fan's port; of no effect without one.

    Returns:
        Angle, range and signed distance of each point.

    Raises:
        InputError: The fan has a port, but no index is given.
    """
    if fan.port is None:
        away = points - fan.origin
        ahead, aside = away @ fan.direction, away @ fan.tangent
        lit = np.where(ahead >= 0, 1.0, np.nan)
        return FanCoordinates(
            lit * np.arctan2(aside, ahead),
            lit * np.hypot(ahead, aside),
            lit * fan.plane.distance_to(points),
        )
    found = locate_points(points, _as_arrays(fan), interfaces_of(fan.port, index))
    return FanCoordinates(*np.ascontiguousarray(found.T))


def as_fan(laser: Laser) -> Fan:
    """Give a laser's fan; one known by its plane alone shines from where that plane is.

    Such a plane's fan starts where the sheet cuts the camera's axis, as in the paper's figure 3,
    and opens by 45 degrees to both sides.
    """
    plane = laser.sheet
    if isinstance(plane, Fan):
        return plane
    at = "xy".index(laser.axis)
    axes = np.eye(3)
    along = axes[1 - at] - (axes[1 - at] @ plane.normal) * plane.normal
    ahead = np.cross(along, plane.normal)
    ahead *= np.sign(ahead[2])
    baseline, _ = laser.as_baseline_angle()
    return Fan.spread(-baseline * axes[at], ahead, along, _HALF_ANGLE)


def equivalent_plane(
    laser: Laser, index: float | None = None, *, near: float = 0.3, far: float = 2.0
) -> Plane:
    """Give the plane that comes nearest to a laser's sheet; a flat sheet gives itself.

    Least squares over all of the fan at depths z from `near` to `far` [m] in the camera frame.
    The paper's b and θ are those of this plane. Do not measure with it: a sheet bent by a port
    may be centimetres off.

    Raises:
        InputError: The laser has a port, but no index is given.
        NotEnoughData: The fan does not reach those depths.
    """
    sheet = laser.sheet
    if isinstance(sheet, Plane) or sheet.port is None:
        return laser.as_plane()
    angles = np.linspace(-sheet.half_angle, sheet.half_angle, _NUM_ANGLES)
    rays = trace_fan(sheet, angles, index)
    with np.errstate(divide="ignore", invalid="ignore"):
        depths = np.linspace(near, far, _NUM_DEPTHS)[:, None]
        reach = (depths - rays.origins[:, 2]) / rays.directions[:, 2]
    reach = np.where(reach >= 0, reach, np.nan)[:, :, None]
    points = (rays.origins + reach * rays.directions).reshape(-1, 3)
    plane = fit_plane(points, tolerance=np.inf).plane
    side = np.sign(plane.normal @ sheet.plane.normal)
    return Plane(side * plane.normal, float(side * plane.distance))


def _keep_lit(fan: Fan, points: Points) -> Points:
    """Replace points of the fan's plane outside its half angle by NaN."""
    away = points - fan.origin
    edge = np.tan(fan.half_angle) * (away @ fan.direction)
    is_lit = np.abs(away @ fan.tangent) <= edge * (1 + 1e-9)
    return np.where(is_lit[:, None], points, np.nan)


def _as_arrays(fan: Fan) -> FanArrays:
    x, y, z = fan.origin, fan.direction, fan.tangent
    return FanArrays(as_triple(x), as_triple(y), as_triple(z), float(np.tan(fan.half_angle)))


def light_across(laser: Laser, index: float | None = None) -> Vector:
    """Give where a laser's light goes, as far as it goes across the stripe.

    Args:
        laser: The laser.
        index: Refractive index of what lies outside; may be left out where no port is.

    Returns:
        Unit direction in the camera frame, away from the camera.
    """
    along = np.array([1.0, 0.0, 0.0] if laser.axis == "y" else [0.0, 1.0, 0.0])
    light = np.cross(equivalent_plane(laser, index).normal, along)
    return light * np.copysign(1 / np.linalg.norm(light), light[2])
