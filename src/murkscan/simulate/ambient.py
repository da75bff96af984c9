"""Light that does not come from the laser: the objects in daylight, and the veil before them."""

import math

import cv2
import numpy as np
from jaxtyping import Bool

from ..geometry.ray_casting import Hits
from ..optics import back_project
from ..types.arrays import Indices, Pixels, Scalars
from ..types.pose import Pose
from ..types.rays import Rays
from .lit_line import to_world
from .range_image import cast_picture
from .scene import Scene
from .sensor import Picture, blur_lens

_CONTRAST = 0.03
"""Share of the brightest by which neighbouring pixels may differ before they are averaged."""
_ENDLESS = 1e9
"""Range of what shows no object [m]: finite, so that clear water before it stays clear."""
_SAMPLES = 16
"""Rays with which a pixel at an edge is looked at again: no two of them share a row or column, so
that along an edge in any direction they lie evenly."""


def draw_ambient(scene: Scene, number: int) -> Picture:
    """Give the radiance of everything in a frame in even light from all sides [W/m²/sr].

    What faces away from the camera is up to half as bright; the water between gives back as much
    light as it scatters out of the way. Pixels at edges are averaged over their area; then the
    lens blurs.

    References:
        Duntley, The visibility of submerged objects, 1952: apparent radiance is what is left of the
        object's own, and of the water's beyond it.
    """
    pose, (width, height) = scene.pose(number), scene.rig.camera.size
    v, u = np.mgrid[:height, :width].reshape(2, -1).astype(float)
    rays = _rays_of(scene, pose, np.stack([u, v], axis=1))
    hits = cast_picture(scene.surroundings.caster, rays, (height, width))
    picture = _shade(scene, rays, hits).reshape(height, width).astype(np.float32)
    edges = np.flatnonzero(_is_uneven(picture).ravel())
    if len(edges):
        picture.ravel()[edges] = _average(scene, pose, edges, width)
    sensor = scene.sensor
    blurs = math.hypot(sensor.psf, sensor.composite), math.hypot(sensor.psf, sensor.field_blur)
    blurred = blur_lens(picture, *blurs)
    return blurred * np.float32(scene.light.ambient / math.pi)


def _rays_of(scene: Scene, pose: Pose, pixels: Pixels) -> Rays:
    return to_world(back_project(scene.rig.camera, pixels, scene.index), pose)


def _shade(scene: Scene, rays: Rays, hits: Hits) -> Scalars:
    """Give what comes along rays, as a share of the radiance of the light around."""
    met = np.flatnonzero(hits.is_hit)
    points = rays.origins[met] + hits.range[met, None] * rays.directions[met]
    left = np.exp(-scene.attenuation * np.minimum(hits.range, _ENDLESS))
    veil = (scene.medium.single_scattering_albedo if scene.medium else 0.0) * (1 - left)
    normals = scene.surroundings.caster.normals[hits.face[met]]
    facing = np.abs(np.einsum("ij,ij->i", normals, rays.directions[met]))
    veil[met] += (
        scene.surroundings.albedo(points, hits.face[met]) * (0.5 + 0.5 * facing) * left[met]
    )
    return veil


def _is_uneven(picture: Picture) -> Bool[np.ndarray, "h w"]:
    """Tell which pixels differ from a neighbour."""
    around = np.ones((3, 3), np.uint8)
    contrast = cv2.dilate(picture, around) - cv2.erode(picture, around)
    return contrast > _CONTRAST * picture.max()


def _average(scene: Scene, pose: Pose, which: Indices, width: int) -> Scalars:
    """Average over the area of some pixels, by rays that are spread over it evenly."""
    step = (np.arange(_SAMPLES) + 0.5) / _SAMPLES - 0.5
    # Every seventh row: a lattice whose points lie evenly in all directions.
    offsets = np.stack([step, step[(7 * np.arange(_SAMPLES)) % _SAMPLES]], axis=1)
    v, u = np.divmod(which, width)
    pixels = (np.stack([u, v], axis=1)[:, None] + offsets).reshape(-1, 2)
    rays = _rays_of(scene, pose, pixels)
    return (
        _shade(scene, rays, scene.surroundings.caster.first_hits(rays))
        .reshape(-1, _SAMPLES)
        .mean(axis=1)
    )
