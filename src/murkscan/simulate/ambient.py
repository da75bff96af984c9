"""Light that does not come from the laser: objects by day or in lamplight, and the veil before."""

import math

import cv2
import numpy as np
from jaxtyping import Bool

from ..geometry.ray_casting import Hits
from ..optics import back_project
from ..optics.sensor import Picture
from ..types.arrays import Indices, Pixels, Scalars
from ..types.pose import Pose
from ..types.rays import Rays
from .lit_line import to_world
from .range_image import cast_picture
from .scene import Scene
from .sensor import blur_lens, compare_colours

_CONTRAST = 0.03
"""Share of the brightest by which neighbouring pixels may differ before they are averaged."""
_ENDLESS = 1e9
"""Range of what shows no object [m]: finite, so that clear water before it stays clear."""
_VEIL = 12
"""Pixels from one place to the next at which the water's light is looked up."""
_SAMPLES = 16
"""Rays with which a pixel at an edge is looked at again: no two of them share a row or column, so
that along an edge in any direction they lie evenly."""


def draw_ambient(scene: Scene, number: int) -> Picture:
    """Give the radiance of everything in a frame in daylight and lamplight [W/m²/sr].

    Daylight comes evenly from all sides: what faces away from the camera is up to half as bright;
    the water between gives back as much light as it scatters out of the way. Pixels at edges are
    averaged over their area; then the lens blurs.

    References:
        Duntley, The visibility of submerged objects, 1952: apparent radiance is what is left of the
        object's own, and of the water's beyond it.
    """
    pose, (width, height) = scene.pose(number), scene.rig.camera.size
    v, u = np.mgrid[:height, :width].reshape(2, -1).astype(float)
    rays = _rays_of(scene, pose, np.stack([u, v], axis=1))
    hits = cast_picture(scene.surroundings.caster, rays, (height, width))
    picture = _shade(scene, pose, rays, hits).reshape(height, width).astype(np.float32)
    edges = np.flatnonzero(_is_uneven(picture).ravel())
    if len(edges):
        picture.ravel()[edges] = _average(scene, pose, edges, width)
    sensor = scene.sensor
    blurs = math.hypot(sensor.psf, sensor.composite), math.hypot(sensor.psf, sensor.field_blur)
    picture += _veil_of_lamp(scene, pose, rays, hits, (height, width))
    return blur_lens(picture, *blurs) * compare_colours(sensor, scene.light, scene.rig.camera)


def _rays_of(scene: Scene, pose: Pose, pixels: Pixels) -> Rays:
    return to_world(back_project(scene.rig.camera, pixels, scene.index), pose)


def _shade(scene: Scene, pose: Pose, rays: Rays, hits: Hits) -> Scalars:
    """Give what comes along rays [W/m²/sr], but for the water in the lamp's light."""
    met = np.flatnonzero(hits.is_hit)
    points = rays.origins[met] + hits.range[met, None] * rays.directions[met]
    left = np.exp(-scene.attenuation * np.minimum(hits.range, _ENDLESS))
    veil = (scene.medium.single_scattering_albedo if scene.medium else 0.0) * (1 - left)
    light = veil * scene.light.ambient
    normals = scene.surroundings.caster.normals[hits.face[met]]
    facing = np.abs(np.einsum("ij,ij->i", normals, rays.directions[met]))
    falls = scene.light.ambient * (0.5 + 0.5 * facing)
    if scene.light.lamp.power > 0:
        seen = pose.inverse() @ points
        falls += scene.light.lamp.irradiance(seen, normals @ pose.rotation, scene.attenuation)
    light[met] += scene.surroundings.albedo(points, hits.face[met]) * falls * left[met]
    return light / math.pi


def _veil_of_lamp(
    scene: Scene, pose: Pose, rays: Rays, hits: Hits, shape: tuple[int, int]
) -> Picture | float:
    """Give the light of the lamp that the water throws back: smooth, so that few rays tell it."""
    if scene.light.lamp.power == 0 or scene.medium is None:
        return 0.0
    rows, columns = (np.append(np.arange(0, side - 1, _VEIL), side - 1) for side in shape)
    nodes = (rows[:, None] * shape[1] + columns).ravel()
    back = pose.inverse()
    some = Rays(back @ rays.origins[nodes], rays.directions[nodes] @ pose.rotation)
    veil = scene.light.lamp.veil(some, hits.range[nodes], scene.medium)
    veil = veil.reshape(len(rows), len(columns)).astype(np.float32)
    places = [np.interp(np.arange(side), node, np.arange(len(node)))
              for side, node in zip(shape, (rows, columns), strict=True)]  # fmt: skip
    v, u = (place.astype(np.float32) for place in np.meshgrid(*places, indexing="ij"))
    return cv2.remap(veil, u, v, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)


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
        _shade(scene, pose, rays, scene.surroundings.caster.first_hits(rays))
        .reshape(-1, _SAMPLES)
        .mean(axis=1)
    )
