"""What a rig's covariance means where boards were seen: at their distances, in their pixels."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from ..optics import back_project, perturb_rig
from ..optics.uncertainty import common_covariances
from ..types.arrays import Pixels, Points, Scalars
from ..types.rig import Rig
from ..types.rig_covariance import unit_of
from .adjust.observations import index_of
from .adjust.parameters import MOUNT
from .calibration import Calibration

_STEPS = {"px": 1e-2, "m": 1e-5, "rad": 1e-5, "": 1e-5}
"""Change of a parameter over which its effect is taken."""
_MANY = 200
"""Pixels at which errors are computed, of all that were seen."""


@dataclass(frozen=True)
class LocalError:
    """The error that a calibration leaves at one distance."""

    what: str
    """Of what it is, in words."""
    depth: float
    """Distance z from the camera [m]."""
    sigma: float
    """Standard deviation [m]."""


def errors_where_seen(calibration: Calibration) -> tuple[LocalError, ...]:
    """Compute the error near, in the middle and far, of each laser, or of shapes or places.

    It is the part common to all points, by the calibration alone: of a laser's points on its
    stripes as they were seen; of a camera's or a port's, by how a flat shape would be bent; of a
    mount's, by where on the vehicle's track a point would be put.
    """
    rig = calibration.rig
    if calibration.lasers:
        return tuple(e for n in calibration.lasers for e in _errors_of_laser(calibration, n))
    near, far = min(calibration.depths), max(calibration.depths)
    pixels = _some(calibration.corners)
    what, compute = "a flat shape", shape_sigma
    if calibration.logged is not None:
        what, compute = "a place, by the mount", place_sigma
    return tuple(
        LocalError(what, depth, compute(rig, depth, pixels))
        for depth in (near, float(np.sqrt(near * far)), far)
    )


def _errors_of_laser(calibration: Calibration, number: int) -> list[LocalError]:
    rig, errors = calibration.rig, []
    for sighting in calibration.sightings:
        mine = np.broadcast_to(sighting.laser, len(sighting.stripe)) == number
        if mine.any():
            pixels = _some(sighting.stripe[mine])
            spread = spread_of_points(rig, number, pixels)
            depth = (sighting.camera_from_board @ sighting.points.mean(axis=0)[None])[0, 2]
            sigma = float(np.sqrt(np.nanmean(spread**2)))
            errors.append(LocalError(f"a point of laser {number}", float(depth), sigma))
    errors.sort(key=lambda error: error.depth)
    return [errors[i] for i in sorted({0, len(errors) // 2, len(errors) - 1})]


def shape_sigma(rig: Rig, depth: float, pixels: Pixels) -> float:
    """Compute the standard deviation of a point of a flat shape at a depth [m], in the RMS.

    The shape faces the camera. What only moves or turns all of it is left out: where a board was
    is not what a calibration is asked.
    """

    def place(changed: Rig) -> Points:
        rays = back_project(changed.camera, pixels, index_of(changed))
        reach = (depth - rays.origins[:, 2:]) / rays.directions[:, 2:]
        return rays.origins + reach * rays.directions

    points = place(rig)
    seen = np.isfinite(points).all(axis=1)
    effects = _effects(rig, place)[:, seen].reshape(len(rig.covariance.names), -1)
    motions = _rigid_motions(points[seen])
    effects -= effects @ motions @ np.linalg.pinv(motions)
    return _rms_sigma(effects, rig.covariance.matrix)


def place_sigma(rig: Rig, depth: float, pixels: Pixels) -> float:
    """Compute by how much a mount misplaces points at a depth on the vehicle [m], in the RMS."""
    rays = back_project(rig.camera, pixels, index_of(rig))
    reach = (depth - rays.origins[:, 2:]) / rays.directions[:, 2:]
    points = rays.origins + reach * rays.directions

    def place(changed: Rig) -> Points:
        assert changed.vehicle_from_camera is not None
        return changed.vehicle_from_camera @ points

    mounted = replace(rig, covariance=rig.covariance.select(MOUNT))
    effects = _effects(mounted, place).reshape(len(MOUNT), -1)
    return _rms_sigma(effects, mounted.covariance.matrix)


def spread_of_points(rig: Rig, laser: int, pixels: Pixels) -> Scalars:
    """Compute the standard deviation, of the common part, of the point at each stripe pixel [m]."""
    in_camera = replace(rig, covariance=rig.covariance.without("mount."))
    covariances = common_covariances(pixels, in_camera, laser)
    return np.sqrt(np.maximum(np.trace(covariances, axis1=1, axis2=2), 0.0))


def _some(pixels: Pixels) -> Float[np.ndarray, "_ 2"]:
    """Pick some pixels, evenly along the list."""
    return pixels[np.linspace(0, len(pixels) - 1, min(len(pixels), _MANY)).astype(int)]


def _rms_sigma(effects: Float[np.ndarray, "k m"], covariance: Float[np.ndarray, "k k"]) -> float:
    """Compute the standard deviation of a point, in the RMS, of effects on coordinates."""
    variance = np.einsum("kn,kl,ln->n", effects, covariance, effects)
    return float(np.sqrt(np.mean(variance.reshape(-1, 3).sum(axis=1))))


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
