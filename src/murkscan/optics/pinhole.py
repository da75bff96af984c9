"""From pixels to rays and back, through a lens in one medium."""

import numpy as np

from .._kernels.distortion import distort_points, undistort_points
from ..types.arrays import Pixels, Points
from ..types.camera import Camera
from ..types.rays import Rays


def normalise(camera: Camera, pixels: Pixels) -> Pixels:
    """Remove lens and sensor: give x = X / Z and y = Y / Z of each pixel.

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


def back_project(camera: Camera, pixels: Pixels) -> Rays:
    """Give the ray in the camera frame that each pixel [px] sees along, from the optical centre."""
    flat = normalise(camera, pixels)
    directions = np.concatenate([flat, np.ones((len(flat), 1))], axis=1)
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return Rays(np.zeros_like(directions), directions)


def project(camera: Camera, points: Points) -> Pixels:
    """Give the pixel [px] at which the camera sees each point of the camera frame [m].

    Row i is NaN where point i is not in front of the camera.
    """
    depth = np.where(points[:, 2:] > 0, points[:, 2:], np.nan)
    flat = points[:, :2] / depth
    bent = distort_points(flat, camera.distortion) if camera.is_distorted() else flat
    return bent * camera.focal_length + camera.principal_point
