"""Points in the world as the camera of a scan saw them: from where, and moved by which errors."""

import os
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from jaxtyping import Float

from ..geometry.stripe_blur import Sight
from ..types.arrays import Pixels, Points, Ratios, Scalars, SmallNumbers
from ..types.cloud import PointCloud
from ..types.profile import Profile
from ..types.rig import Rig
from ..types.trajectory import Trajectory
from .sheet import light_across
from .uncertainty import Shifts, common_shifts
from .view import project
from .water import refractive_index

_ASKED = 100
"""Points for which the angle of a pixel is computed: it varies by some per cent over a picture."""
_ASIDE = 1e-3
"""By how much of its range each is moved for that: about a pixel."""
_PART = 20_000
"""Points that one thread works on: some ten megabytes."""


def look_back(cloud: PointCloud, times: Scalars, trajectory: Trajectory, rig: Rig) -> Sight:
    """Find from where each point was seen, where its light came from, and what the finder put back.

    Args:
        cloud: Points in the world.
        times: When each was seen [s].
        trajectory: world_from_camera.
        rig: The rig.
    """
    cameras = trajectory.transform(np.zeros_like(cloud.points), times)
    rays = cloud.points - cameras
    ranges = np.linalg.norm(rays, axis=1)
    rays /= np.maximum(ranges, 1e-12)[:, None]
    index = refractive_index(rig.water, rig.wavelength)
    stripes, lights = np.zeros_like(cloud.points), np.zeros_like(cloud.points)
    for number in np.unique(cloud.laser).tolist():
        mine = cloud.laser == number
        stripes[mine] = (0.0, 1.0, 0.0) if rig.lasers[number].axis == "x" else (1.0, 0.0, 0.0)
        lights[mine] = light_across(rig.lasers[number], index)
    along, light = (trajectory.transform(way, times) - cameras for way in (stripes, lights))
    widths = _angle_of_pixel(cloud, times, trajectory, rig) * ranges * cloud.width
    return Sight(rays, along, light, ranges, cloud.blur_shift.astype(float), widths)


def _angle_of_pixel(cloud: PointCloud, times: Scalars, trajectory: Trajectory, rig: Rig) -> float:
    """Compute how wide a pixel along the stripe looks, as usual for some points [rad]."""
    some = slice(None, None, len(cloud) // _ASKED + 1)
    points = trajectory.to_camera(cloud.points[some], times[some])
    index = refractive_index(rig.water, rig.wavelength)
    step = _ASIDE * np.linalg.norm(points, axis=1, keepdims=True)
    lies_along_y = np.array([laser.axis == "x" for laser in rig.lasers])[cloud.laser[some]]
    aside = np.where(lies_along_y[:, None], (0.0, 1.0, 0.0), (1.0, 0.0, 0.0)) * step
    moved = project(rig.camera, points + aside, index) - project(rig.camera, points, index)
    pixels = np.linalg.norm(moved, axis=1)
    seen = pixels > 0
    return _ASIDE / float(np.median(pixels[seen])) if seen.any() else 0.0


def find_pixels(points: Points, times: Scalars, trajectory: Trajectory, rig: Rig) -> Pixels:
    """Find the pixel at which each point of the world was seen; see `look_back`."""
    index = refractive_index(rig.water, rig.wavelength)
    return project(rig.camera, trajectory.to_camera(points, times), index)


def shift_points(
    pixels: Pixels, laser: SmallNumbers, times: Scalars, trajectory: Trajectory, rig: Rig
) -> Shifts:
    """Compute how far points move with each independent error of their rig, in the world [m].

    Args:
        pixels: Where each point was seen [px].
        laser: Number of the laser that lit each.
        times: When each was seen [s].
        trajectory: world_from_camera.
        rig: The rig as it moves: with its mount only where the poses came through it.

    Returns:
        Shifts at one standard deviation; NaN where a pixel sees no point.
    """
    shifts = _shifts_in_rig(pixels, laser, rig)
    moments, which = np.unique(times, return_inverse=True)
    world_from_rig = trajectory.at(moments).attitudes.as_matrix()
    if rig.vehicle_from_camera is not None:
        world_from_rig = world_from_rig @ rig.vehicle_from_camera.rotation.T
    return world_from_rig[which] @ shifts


def shifts_in_camera(pixels: Pixels, laser: SmallNumbers, rig: Rig) -> Shifts:
    """Compute how far points move with each error of their rig, along the camera's axes.

    The arguments are those of `shift_points`, and so is what comes back [m].
    """
    shifts = _shifts_in_rig(pixels, laser, rig)
    if rig.vehicle_from_camera is None:
        return shifts
    turned: Shifts = rig.vehicle_from_camera.rotation.T @ shifts
    return turned


def _shifts_in_rig(pixels: Pixels, laser: SmallNumbers, rig: Rig) -> Shifts:
    """Compute the shifts of points that several lasers lit, along the axes of `common_shifts`."""
    parts = {n: common_shifts(pixels[laser == n], rig, n) for n in np.unique(laser).tolist()}
    modes = max((part.shape[2] for part in parts.values()), default=0)
    shifts: Float[np.ndarray, "n 3 modes"] = np.zeros((len(pixels), 3, modes))
    for number, part in parts.items():
        shifts[laser == number] = part
    return shifts


def shifts_in_world(profile: Profile, trajectory: Trajectory, rig: Rig) -> Shifts:
    """Compute how far points of a scan move with each independent error of its rig and its motion.

    Args:
        profile: The points, in the camera frame, with the pixels that they come from.
        trajectory: world_from_camera, with its errors where any are stated.
        rig: The rig as it moves: with its mount only where the poses came through it.

    Returns:
        Shifts along the world's axes [m], as of `shift_points`; those of the motion come last.
    """
    by_rig = shift_points(profile.pixels, profile.laser, profile.time, trajectory, rig)
    points = trajectory.transform(profile.points, profile.time)
    return np.concatenate([by_rig, trajectory.shifts(points, profile.time)], axis=2)


def spread_common(profile: Profile, trajectory: Trajectory, rig: Rig) -> Ratios:
    """Compute the common standard deviation of each point, in the direction where it is largest.

    Args:
        profile: The points, with the pixels that they come from.
        trajectory: world_from_camera, with its errors.
        rig: The rig, as it moves in this scan.

    Returns:
        Standard deviations [m]; 0 where neither the rig nor the motion states any, NaN where a
        pixel sees no point.
    """
    sigma = np.zeros(len(profile), np.float32)
    if not rig.covariance.names and trajectory.errors is None:
        return sigma

    def run(start: int) -> None:
        part = slice(start, start + _PART)
        shifts = shifts_in_world(profile[part], trajectory, rig)
        seen = np.isfinite(shifts).all(axis=(1, 2))
        covariances = shifts[seen] @ shifts[seen].transpose(0, 2, 1)
        largest = np.full(len(seen), np.nan)
        largest[seen] = np.sqrt(np.maximum(np.linalg.eigvalsh(covariances)[:, -1], 0.0))
        sigma[part] = largest

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(run, range(0, len(profile), _PART)))
    return sigma
