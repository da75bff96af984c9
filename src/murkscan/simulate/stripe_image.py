"""Draw the light that the surface throws back: the stripe, before the water blurs it."""

import math
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float32

from .._kernels.splat import LineSplats, splat_on_lines
from ..geometry.ray_casting import Hits
from ..optics.beam import Beam
from ..optics.scan_lines import SheetScanLines
from ..types.arrays import Points, Scalars
from ..types.pose import Pose
from ..types.rays import Rays
from .lit_line import LitLine, to_world
from .surface import Surroundings

Picture = Float32[np.ndarray, "h w"]

_REACH, _STEPS = 4.0, 6
"""Standard deviations over which the sheet's thickness is sampled to each side, and the steps that
it takes at least: at this spacing a sum over a Gaussian is its integral to 1e-9."""
_SPACING = 1.4
"""Standard deviations of what blurs each sample, lens and pixel, from one to the next at most: the
ripple of their sum is then 1e-4 of it."""
_PIXEL = 1 / math.sqrt(12)
"""Standard deviation of a place within a pixel [px]."""
_THINNEST, _THICKEST = 0.02, 30.0
"""Bounds of the stripe's own width [px]."""
_SHININESS = 60.0
"""Exponent of the highlight: wet paint's lobe is about ten degrees wide."""


@dataclass(frozen=True, eq=False)
class Rendering:
    """All that light on a surface depends on in one frame."""

    beam: Beam
    scan_lines: SheetScanLines
    surroundings: Surroundings
    attenuation: float
    """Beam attenuation of the water [1/m]."""
    pose: Pose
    """world_from_camera."""


def widths_of(scene: Rendering, line: LitLine) -> Scalars:
    """Give how wide the lit line is along its scan line, without any blur [px], 1σ."""
    step = 0.25
    distances = []
    for side in (-step, step):
        rays = scene.scan_lines.rays(line.lines, line.positions + side)
        ranges = scene.surroundings.caster.range_to_face(to_world(rays, scene.pose), line.face)
        points = rays.origins + ranges[:, None] * rays.directions
        distances.append(scene.beam.locate(points))
    growth = np.abs(distances[1].distance - distances[0].distance) / (2 * step)
    thickness = np.hypot(
        scene.beam.thickness(np.nan_to_num(distances[0].range)),
        scene.surroundings.translucency(line.face),
    )
    with np.errstate(divide="ignore", invalid="ignore"):
        widths = thickness / growth
    return np.clip(np.nan_to_num(widths, nan=_THICKEST), _THINNEST, _THICKEST)


def draw_line(
    scene: Rendering, line: LitLine, widths: Scalars, blur: float, image: Picture, slope: Picture
) -> None:
    """Add the stripe's radiance, blurred along scan lines, and its derivative by its position.

    Args:
        scene: Rig, objects and pose.
        line: The true centres around which light is looked for.
        widths: Of the lit line at each of them [px], 1σ.
        blur: Of the lens, along the scan line [px], 1σ.
        image: Rows are scan lines; radiance [W/m²/sr] is added.
        slope: The same; derivative [W/m²/sr/px] is added.
    """
    if not len(line):
        return
    finest = _SPACING * math.hypot(blur, _PIXEL)
    steps = max(_STEPS, math.ceil(_REACH * float(widths.max()) / finest))
    positions, spacing = _windows(line, widths, 2 * steps + 1)
    lines = np.repeat(line.lines, 2 * steps + 1)
    rays = scene.scan_lines.rays(lines, positions.ravel())
    radiance = radiance_along(scene, rays)
    splats = LineSplats(lines, positions.ravel(), radiance * spacing.ravel())
    splat_on_lines(splats, blur, image, slope)


def radiance_along(scene: Rendering, rays: Rays) -> Scalars:
    """Give what comes straight from the lit surface along rays of the camera [W/m²/sr]."""
    hits = scene.surroundings.caster.first_hits(to_world(rays, scene.pose))
    radiance = np.zeros(len(hits.face))
    met = np.flatnonzero(hits.is_hit)
    if len(met):
        seen = Rays(rays.origins[met], rays.directions[met])
        radiance[met] = _radiance(scene, seen, Hits(hits.face[met], hits.range[met]))
    return radiance


def _windows(line: LitLine, widths: Scalars, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Spread samples over each stripe, up to half way to its neighbour in the scan line."""
    half = np.diff(line.positions) / 2
    joined = np.diff(line.lines) == 0
    room = np.where(joined, half, np.inf)
    below, above = np.concatenate([[np.inf], room]), np.concatenate([room, [np.inf]])
    low = -np.minimum(_REACH * widths, below)
    high = np.minimum(_REACH * widths, above)
    share = np.linspace(0.0, 1.0, count)
    positions = line.positions[:, None] + low[:, None] + share * (high - low)[:, None]
    spacing = np.broadcast_to(((high - low) / (count - 1))[:, None], positions.shape).copy()
    spacing[:, [0, -1]] /= 2  # trapezoid rule, which matters where a neighbour cuts the window
    return positions, spacing


def _radiance(scene: Rendering, rays: Rays, hits: Hits) -> Scalars:
    """Shade what these rays, which all meet something, meet."""
    points = rays.origins + hits.range[:, None] * rays.directions
    where = scene.beam.locate(points)
    starts = scene.beam.rays(np.nan_to_num(where.angle)).origins
    lit_along, way = _towards(starts, points)
    normals = scene.surroundings.caster.normals[hits.face] @ scene.pose.rotation
    facing = -np.einsum("ij,ij->i", normals, lit_along)
    viewed = -np.einsum("ij,ij->i", normals, rays.directions)
    spread = scene.surroundings.translucency(hits.face)
    light = np.nan_to_num(scene.beam.irradiance(where, spread))
    light = np.where(facing * viewed > 0, light, 0.0)
    bright = np.flatnonzero(light > 1e-9 * light.max(initial=0.0))
    lit = Rays(starts[bright], lit_along[bright])
    free = scene.surroundings.caster.is_free(to_world(lit, scene.pose), way[bright])
    light[bright] *= free
    albedo = scene.surroundings.albedo(scene.pose @ points, hits.face)
    mirrored = _highlight(scene, rays, hits, lit_along, normals)
    mat = (1 - scene.surroundings.gloss(hits.face)) * albedo / math.pi
    left = np.exp(-scene.attenuation * (way + hits.range))
    return light * np.abs(facing) * (mat + mirrored) * left


def _highlight(
    scene: Rendering, rays: Rays, hits: Hits, lit_along: Points, normals: Points
) -> Scalars:
    """Give the gloss's own reflectance [1/sr]: a lobe around the mirrored light.

    References:
        Blinn, Models of light reflection for computer synthesized pictures, SIGGRAPH 1977; scaled
        to mirror its share of the light as in Akenine-Möller et al., Real-Time Rendering.
    """
    gloss = scene.surroundings.gloss(hits.face)
    if not gloss.any():
        return gloss
    middle = lit_along + rays.directions
    middle /= np.maximum(np.linalg.norm(middle, axis=1, keepdims=True), 1e-12)
    cosine = np.abs(np.einsum("ij,ij->i", normals, middle))
    return gloss * (_SHININESS + 8) / (8 * math.pi) * cosine**_SHININESS


def _towards(starts: Points, ends: Points) -> tuple[Points, Scalars]:
    away = ends - starts
    length = np.linalg.norm(away, axis=1)
    return away / np.maximum(length, 1e-12)[:, None], length
