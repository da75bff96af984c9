"""What a rig's covariance means where it measures: near, in the middle and far."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from ..optics import back_project, intersect_rays_with_sheet, perturb_rig
from ..optics.uncertainty import common_covariances
from ..types.arrays import Pixels, Points, Scalars
from ..types.pose import Pose
from ..types.rig import Rig
from ..types.rig_covariance import unit_of
from .observed import index_of
from .sighting import Sighting

_STEPS = {"px": 1e-2, "m": 1e-5, "rad": 1e-5, "": 1e-5}
"""Change of a parameter over which its effect is taken."""
_GRID = (12, 8)
"""Pixels along u and v on which shapes are judged."""
_LINES, _SAMPLES = 9, 400
"""Scan lines on which a sheet is judged, and pixels looked at along each."""


def reach_of(
    camera_from_boards: Sequence[Pose], sightings: Sequence[Sighting]
) -> tuple[float, float, float]:
    """Give the depths z of the nearest, a middle and the farthest board [m]."""
    depths = [
        (pose @ sighting.points.mean(axis=0)[None])[0, 2]
        for pose, sighting in zip(camera_from_boards, sightings, strict=True)
    ]
    near, far = float(min(depths)), float(max(depths))
    return near, float(np.sqrt(near * far)), far


def shape_sigma(rig: Rig, depth: float) -> float:
    """Give the standard deviation of a point of a flat shape at a depth [m], in the RMS.

    The shape faces the camera and fills its picture. What only moves or turns all of it is left
    out: where a board was is not what a calibration is asked.
    """
    width, height = rig.camera.size
    u, v = np.meshgrid(np.linspace(0, width - 1, _GRID[0]), np.linspace(0, height - 1, _GRID[1]))
    pixels = np.stack([u.ravel(), v.ravel()], axis=1)

    def place(changed: Rig) -> Points:
        rays = back_project(changed.camera, pixels, index_of(changed))
        reach = (depth - rays.origins[:, 2:]) / rays.directions[:, 2:]
        return rays.origins + reach * rays.directions

    points = place(rig)
    seen = np.isfinite(points).all(axis=1)
    effects = _effects(rig, place)[:, seen].reshape(len(rig.covariance.names), -1)
    motions = _rigid_motions(points[seen])
    effects -= effects @ motions @ np.linalg.pinv(motions)
    variance = np.einsum("kn,kl,ln->n", effects, rig.covariance.matrix, effects)
    return float(np.sqrt(np.mean(variance.reshape(-1, 3).sum(axis=1))))


def point_sigma(rig: Rig, laser: int, depth: float) -> float:
    """Give the standard deviation of a point of a laser's stripe at a depth [m], in the RMS.

    The part common to all points of a scan; NaN where the stripe is not in the picture there.
    """
    pixels = _stripe_at(rig, laser, depth)
    if len(pixels) == 0:
        return np.nan
    return float(np.sqrt(np.nanmean(spread_of_points(rig, laser, pixels) ** 2)))


def spread_of_points(rig: Rig, laser: int, pixels: Pixels) -> Scalars:
    """Give the standard deviation of the point at each pixel of a stripe [m]: the common part."""
    in_camera = replace(rig, covariance=rig.covariance.without("mount."))
    covariances = common_covariances(pixels, in_camera, laser)
    return np.sqrt(np.maximum(np.trace(covariances, axis1=1, axis2=2), 0.0))


def _effects(rig: Rig, place: Callable[[Rig], Points]) -> Float[np.ndarray, "k n 3"]:
    """Differentiate points by each parameter of the covariance."""
    effects = []
    for name in rig.covariance.names:
        step = np.array([_STEPS[unit_of(name)]])
        ahead, behind = (place(perturb_rig(rig, [name], s)) for s in (step, -step))
        effects.append((ahead - behind) / (2 * step))
    shape = place(rig).shape
    return np.stack(effects) if effects else np.zeros((0, *shape))


def _rigid_motions(points: Points) -> Float[np.ndarray, "m 6"]:
    """Give how the coordinates of points change with each of the six motions."""
    turns = [np.cross(axis, points - points.mean(axis=0)).ravel() for axis in np.eye(3)]
    shifts = [np.tile(axis, len(points)) for axis in np.eye(3)]
    return np.stack([*turns, *shifts], axis=1)


def _measure(rig: Rig, laser: int, pixels: Pixels) -> Points:
    rays = back_project(rig.camera, pixels, index_of(rig))
    return intersect_rays_with_sheet(rays, rig.laser(laser), index_of(rig))


def _stripe_at(rig: Rig, laser: int, depth: float) -> Pixels:
    """Give pixels at which a stripe at this depth is seen, on some scan lines."""
    width, height = rig.camera.size
    across, along = (0, 1) if rig.laser(laser).axis == "x" else (1, 0)
    lines = np.linspace(0, (width, height)[along] - 1, _LINES)
    steps = np.linspace(0, (width, height)[across] - 1, _SAMPLES)
    found = []
    for line in lines:
        pixels = np.zeros((_SAMPLES, 2))
        pixels[:, across], pixels[:, along] = steps, line
        at = _crossing(steps, _measure(rig, laser, pixels)[:, 2], depth)
        pixel = np.zeros(2)
        pixel[across], pixel[along] = at, line
        found.append(pixel)
    pixels = np.array(found)
    return pixels[np.isfinite(pixels).all(axis=1)]


def _crossing(steps: Scalars, depths: Scalars, depth: float) -> float:
    """Give where a sequence of depths first passes the wanted one; NaN if never."""
    side = depths > depth
    usable = np.isfinite(depths[:-1]) & np.isfinite(depths[1:]) & (side[:-1] != side[1:])
    # From the front to the back of infinity the depth jumps; that is no crossing.
    usable &= np.abs(np.diff(depths)) < depth
    if not usable.any():
        return np.nan
    i = int(np.argmax(usable))
    share = (depth - depths[i]) / (depths[i + 1] - depths[i])
    return float(steps[i] + share * (steps[i + 1] - steps[i]))
