"""From pixels to rays and back, through the lens and the window before it."""

import numpy as np

from .._kernels.distortion import distort_points, undistort_points
from .._kernels.refraction import aim_through_planes, aim_through_spheres, trace_rays
from ..types.arrays import Directions, Pixels, Points
from ..types.camera import Camera
from ..types.port import FlatPort
from ..types.rays import Rays
from .interfaces import interfaces_of


def normalise(camera: Camera, pixels: Pixels) -> Pixels:
    """Remove lens and sensor: give x = X / Z and y = Y / Z of each pixel, inside the housing.

    Args:
        camera: The camera that saw the pixels.
        pixels: Image points [px].

    Returns:
        Normalised image coordinates, without a unit; `distort_points` inverts them to 1e-12.

    References:
        Brown 1971 for the distortion; inverted by Newton's method.
    """
    flat = (pixels - camera.principal_point) / camera.focal_length
    return undistort_points(flat, camera.distortion) if camera.is_distorted() else flat


def back_project(camera: Camera, pixels: Pixels, index: float | None = None) -> Rays:
    """Give the ray in the camera frame that each pixel sees along.

    Args:
        camera: The camera that saw the pixels.
        pixels: Image points [px].
        index: Refractive index of what lies outside the camera's port; of no effect without one.

    Returns:
        The rays. Without a port they start at the optical centre, otherwise on the outer face of
        the port; NaN where a ray misses the port.

    Raises:
        InputError: The camera has a port, but no index is given.

    References:
        Glassner, An Introduction to Ray Tracing, 1989, chapter 2, for Snell's law with vectors;
        Agrawal, Ramalingam, Taguchi and Chari, A theory of multi-layer flat refractive geometry,
        CVPR 2012, for the camera behind a flat port.
    """
    flat = normalise(camera, pixels)
    directions = np.concatenate([flat, np.ones((len(flat), 1))], axis=1)
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    if camera.port is None:
        return Rays(np.zeros_like(directions), directions)
    return Rays(*trace_rays(directions, interfaces_of(camera.port, index)))


def project(camera: Camera, points: Points, index: float | None = None) -> Pixels:
    """Give the pixel at which the camera sees each point; the inverse of `back_project`.

    Args:
        camera: The camera.
        points: Points in the camera frame [m].
        index: Refractive index of what lies outside the camera's port; of no effect without one.

    Returns:
        Image points [px]; NaN where a point is not in front of the camera, or not outside its
        port.

    Raises:
        InputError: The camera has a port, but no index is given.
    """
    aims = _aim(camera, points, index)
    depth = np.where(aims[:, 2:] > 0, aims[:, 2:], np.nan)
    flat = aims[:, :2] / depth
    bent = distort_points(flat, camera.distortion) if camera.is_distorted() else flat
    return bent * camera.focal_length + camera.principal_point


def _aim(camera: Camera, points: Points, index: float | None) -> Directions:
    """Give the direction, of any length, in which light from each point enters the lens."""
    if camera.port is None:
        return points
    interfaces = interfaces_of(camera.port, index)
    if isinstance(camera.port, FlatPort):
        return aim_through_planes(points, interfaces)
    return aim_through_spheres(points, interfaces)
