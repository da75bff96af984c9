"""The second line: light that a glossy surface mirrors onto another, or onto itself."""

import math
from dataclasses import dataclass, fields

import numpy as np

from .._kernels.splat import splat_discs
from ..types.arrays import Directions, Indices, Points, Scalars
from ..types.rays import Rays
from .lit_line import WIDEST, Fall, LitLine, cross_scan_lines, to_world
from .stripe_image import Picture, Rendering

_OFF = 1e-4
"""How far above the surface mirrored rays start [m], so that they do not meet it at once."""


@dataclass(frozen=True, eq=False)
class Mirrored:
    """Where the fan's mirrored rays land; one a row."""

    number: Indices
    """Number of the fan's ray."""
    points: Points
    """Where it lands, in the camera frame [m]."""
    face: Indices
    """On which triangle."""
    power: Scalars
    """What is left of it there, for one ray of the fan [W]."""
    away: Directions
    """The direction in which it came."""
    way: Scalars
    """How far it has come [m]."""


def mirror(scene: Rendering, fall: Fall) -> Mirrored:
    """Follow the fan's rays beyond the glossy surfaces that they meet first."""
    met = np.flatnonzero(fall.face >= 0)
    gloss = scene.surroundings.gloss(fall.face[met])
    met, gloss = met[gloss > 0], gloss[gloss > 0]
    caster = scene.surroundings.caster
    normals = caster.normals[fall.face[met]] @ scene.pose.rotation
    came = fall.rays.directions[met]
    facing = np.einsum("ij,ij->i", normals, came)[:, None]
    gone = came - 2 * facing * normals
    starts = fall.rays.origins[met] + fall.ranges[met, None] * came
    rays = Rays(starts - np.sign(facing) * _OFF * normals, gone)
    hits = caster.first_hits(to_world(rays, scene.pose))
    lands = np.flatnonzero(hits.is_hit)
    points = rays.origins[lands] + hits.range[lands, None] * gone[lands]
    way = fall.ranges[met[lands]] + hits.range[lands]
    power = _power_a_ray(scene, fall)[met[lands]] * gloss[lands] * _through(scene, way)
    return Mirrored(met[lands], points, hits.face[lands], power, gone[lands], way)


def draw_mirrored(scene: Rendering, mirrored: Mirrored, blur: float, image: Picture) -> LitLine:
    """Add the second line's radiance to an image (rows are v), and give its true centres.

    Where neighbouring rays land apart, their light is spread along the way between; the true
    centres are interpolated likewise.
    """
    seen = mirrored if not len(mirrored.number) else _keep_seen(scene, mirrored)
    if not len(seen.number):
        nothing = np.zeros(0, int)
        return LitLine(nothing, np.zeros(0), np.zeros((0, 3)), nothing)
    _draw_between(scene, seen, blur, image)
    found = cross_scan_lines(scene.scan_lines, seen.number, seen.points)
    ends = seen.points[found.before], seen.points[found.before + 1]
    points = ends[0] + found.share[:, None] * (ends[1] - ends[0])
    return LitLine(found.lines, found.positions, points, seen.face[found.before])


def _draw_between(scene: Rendering, seen: Mirrored, blur: float, image: Picture) -> None:
    """Draw spots, half a pixel apart, from each ray's landing place to the next one's."""
    across, along = scene.scan_lines.project(seen.points)
    pixels = scene.scan_lines.as_pixels(across, along)
    scale = scene.scan_lines.pixels_per_area(seen.points)
    amounts = _reflected_towards_camera(scene, seen, scene.scan_lines.rays(across, along)) * scale
    sigmas = np.hypot(blur, scene.beam.thickness(seen.way) * np.sqrt(scale))
    gap = np.linalg.norm(np.diff(pixels, axis=0), axis=1)
    joined = (np.diff(seen.number) == 1) & (gap < WIDEST)
    count = np.where(joined, np.ceil(2 * np.nan_to_num(gap)) + 1, 0).astype(int)
    before = np.repeat(np.arange(len(count)), count)
    step = np.arange(len(before)) - np.repeat(np.cumsum(count) - count, count)
    share = (step + 0.5) / count[before]
    places = pixels[before] + share[:, None] * (pixels[before + 1] - pixels[before])
    light = (amounts[before] + amounts[before + 1]) / 2 / count[before]
    known = np.isfinite(places[:, 0]) & np.isfinite(light)
    splat_discs(places[known], sigmas[before][known], light[known], image)


def _keep_seen(scene: Rendering, mirrored: Mirrored) -> Mirrored:
    """Leave out what the camera does not see, or sees from behind."""
    across, along = scene.scan_lines.project(mirrored.points)
    rays = scene.scan_lines.rays(across, along)
    ranges = np.linalg.norm(mirrored.points - rays.origins, axis=1)
    caster = scene.surroundings.caster
    normals = caster.normals[mirrored.face] @ scene.pose.rotation
    sides = [np.einsum("ij,ij->i", normals, way) for way in (rays.directions, mirrored.away)]
    seen = caster.is_free(to_world(rays, scene.pose), np.nan_to_num(ranges, nan=np.inf))
    seen &= np.nan_to_num(sides[0] * sides[1]) > 0
    return Mirrored(*(getattr(mirrored, column.name)[seen] for column in fields(Mirrored)))


def _reflected_towards_camera(scene: Rendering, seen: Mirrored, rays: Rays) -> Scalars:
    """Give each ray's light along these rays of the camera: radiance times area [W/sr]."""
    ranges = np.linalg.norm(seen.points - rays.origins, axis=1)
    albedo = scene.surroundings.albedo(scene.pose @ seen.points, seen.face)
    normals = scene.surroundings.caster.normals[seen.face] @ scene.pose.rotation
    viewed = np.abs(np.einsum("ij,ij->i", normals, rays.directions))
    return albedo / math.pi * seen.power * viewed * _through(scene, ranges)


def _power_a_ray(scene: Rendering, fall: Fall) -> Scalars:
    """Give the power that each of the fan's rays stands for [W]."""
    step = fall.angles[1] - fall.angles[0]
    return scene.beam.power_per_angle(fall.angles) * step


def _through(scene: Rendering, way: Scalars) -> Scalars:
    return np.exp(-scene.attenuation * way)
