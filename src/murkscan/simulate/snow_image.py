"""Draw the particles that the sheet cuts."""

import math

import numpy as np

from .._kernels.splat import splat_discs
from ..types.arrays import Pixels, Points
from .laser_view import DARK, LaserView
from .particles import Particles, Snow
from .stripe_image import Picture, Rendering

_COUNTED = 4.0
"""Thickness of the sheet within which a particle counts as cut by it [standard deviations]."""
_DRAWN = 4.0
"""Distance from the sheet's middle up to which particles are drawn [standard deviations]."""
_ACROSS, _ALONG = 8, 2
"""Pixels from one place where particles are looked for to the next: along scan lines, where the
sheet is seen aslant, they must be nearer."""


def density_for(particles: Particles, laser: LaserView, mask: Picture, reach: float) -> float:
    """Give the particles a cubic metre of which the sheet cuts as many as are wished for [1/m³].

    Args:
        particles: What they are like, and how many.
        laser: The laser.
        mask: Share of each pixel's sheet that is lit and in sight.
        reach: Range of the farthest that the sheet meets [m]: beyond it particles do not count.
    """
    points = laser.view.points.reshape(*mask.shape, 3)
    near = (mask > 0.5) & (laser.view.camera_range.reshape(mask.shape) < reach)
    sides = np.gradient(points, axis=0), np.gradient(points, axis=1)
    areas = np.linalg.norm(np.cross(*sides), axis=2)
    thickness = _COUNTED * laser.beam.thickness(laser.view.laser_range)
    volume = np.nansum(np.where(near, areas * thickness.reshape(mask.shape), 0.0))
    return particles.per_frame / float(volume) if volume > 0 else 0.0


def places_in_light(laser: LaserView, mask: Picture, attenuation: float) -> Points:
    """Give places of the sheet, in the camera frame [m], around which particles may be seen."""
    steps = (_ALONG, _ACROSS) if laser.scan_lines.laser.axis == "y" else (_ACROSS, _ALONG)
    tried = np.arange(mask.size).reshape(mask.shape)[:: steps[0], :: steps[1]]
    seen = laser.view[tried[mask[:: steps[0], :: steps[1]] > 0.0]]
    # At a pixel's edge light may be, and no sheet: NaN is not in light.
    return seen.points[attenuation * (seen.laser_range + seen.camera_range) < DARK]


def draw_snow(
    scene: Rendering, snow: Snow, albedo: float, blur: float, mask: Picture, image: Picture
) -> None:
    """Add the radiance of particles to an image, blurred by the lens.

    Args:
        scene: Rig, objects and pose.
        snow: The particles.
        albedo: Share of light that they throw back, as a mat disc would.
        blur: Of the lens [px], 1σ.
        mask: Share of each pixel's sheet that is lit and in sight.
        image: Rows are v; radiance [W/m²/sr] is added.
    """
    points = scene.pose.inverse() @ snow.points
    near = np.flatnonzero(scene.beam.may_light(points, _DRAWN))
    points, diameters = points[near], snow.diameters[near]
    where = scene.beam.locate(points)
    cut = np.flatnonzero(
        np.abs(where.distance) < _DRAWN * scene.beam.thickness(np.nan_to_num(where.range))
    )
    across, along = scene.scan_lines.project(points[cut])
    pixels = scene.scan_lines.as_pixels(across, along)
    share = _look_up(mask, pixels)
    known = np.flatnonzero(np.isfinite(across) & (share > 0))
    shown = cut[known]
    points, diameters, where = points[shown], diameters[shown], where[shown]
    pixels, share = pixels[known], share[known]
    ranges = np.linalg.norm(
        points - scene.scan_lines.rays(across[known], along[known]).origins, axis=1
    )
    size = diameters * np.sqrt(scene.scan_lines.pixels_per_area(points))
    light = scene.beam.irradiance(where) * np.exp(-scene.attenuation * (where.range + ranges))
    amounts = share * light * (albedo / math.pi) * (math.pi / 4) * size**2
    bright = amounts > 0
    sigmas = np.hypot(blur, size / 4)[bright]  # a disc's variance is a sixteenth of its width's
    splat_discs(pixels[bright], sigmas, amounts[bright], image)


def _look_up(mask: Picture, pixels: Pixels) -> np.ndarray:
    """Give the value of the pixel that each point falls on; 0 outside the picture."""
    u, v = np.rint(np.nan_to_num(pixels, nan=-1e6)).astype(int).T
    height, width = mask.shape
    inside = (u >= 0) & (u < width) & (v >= 0) & (v < height)
    return np.where(inside, mask[np.clip(v, 0, height - 1), np.clip(u, 0, width - 1)], 0.0)
