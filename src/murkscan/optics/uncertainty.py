"""How far a rig's own errors move the points that it measures: the part that all points share.

Averaging many points of a scan does not help against these, and a length between two points of a
scan feels only their difference.
"""

from collections.abc import Iterator

import numpy as np
from jaxtyping import Float

from ..types.arrays import Pixels, Points, Scalars
from ..types.rig import Rig
from ..types.rig_covariance import RigCovariance
from .rig_parameters import perturb_rig
from .sheet import intersect_rays_with_sheet
from .view import back_project
from .water import refractive_index

Shifts = Float[np.ndarray, "n 3 modes"]
"""How far each point moves with each independent error of a rig, at one standard deviation [m]."""
_STEP = 0.1
"""Size of an error for the derivative of a point, in its standard deviation: where it matters."""
_NEGLIGIBLE = 1e-12
"""Variance of a mode, over the largest, that rounding alone may have made."""
_BLOCK = 20_000
"""Points that are looked at together: some ten megabytes."""


def error_modes(covariance: RigCovariance) -> Float[np.ndarray, "parameters modes"]:
    """Give independent errors of a rig, each of standard deviation 1: L with L Lᵀ the covariance.

    Args:
        covariance: How well the rig's parameters are known.

    Returns:
        The change of each parameter, in the order of the covariance's names, with each error.
    """
    sigma = covariance.sigma
    variances, directions = np.linalg.eigh(covariance.correlation)
    kept = variances > _NEGLIGIBLE * max(float(variances.max(initial=0.0)), 1e-300)
    return sigma[:, None] * directions[:, kept] * np.sqrt(variances[kept])


def common_shifts(pixels: Pixels, rig: Rig, laser: int = 0) -> Shifts:
    """Give how far each point moves with each independent error of its rig.

    The covariance of points i and j is the product of their shifts, `shifts[i] @ shifts[j].T`: to
    first order in the errors, at a tenth of their standard deviations.

    Args:
        pixels: Stripe centres of the points [px].
        rig: The calibrated rig, with its covariance.
        laser: Number of the laser.

    Returns:
        Shifts [m] in the frame that the rig moves with: along the vehicle's axes where the rig has
        a mount, otherwise along the camera's. NaN where a pixel sees no point. Without covariance
        there are no modes.

    Raises:
        InputError: The covariance names a parameter that the rig does not have.

    References:
        JCGM 100:2008, Guide to the expression of uncertainty in measurement, section 5.2, for
        inputs that vary together; its section 5.1.3, note 2, for the differences.
    """
    modes = error_modes(rig.covariance)
    shifts = np.empty((len(pixels), 3, modes.shape[1]))
    if modes.shape[1] == 0:
        return shifts
    here = _locate(pixels, rig, laser)
    for number, mode in enumerate(modes.T):
        ahead, behind = (
            _locate(pixels, perturb_rig(rig, rig.covariance.names, sign * _STEP * mode), laser)
            for sign in (1.0, -1.0)
        )
        # At the very edge of the sheet one of the rays may miss it: there the other side is taken.
        ahead_is_seen, behind_is_seen = np.isfinite(ahead), np.isfinite(behind)
        width = _STEP * (ahead_is_seen.astype(float) + behind_is_seen)
        ahead, behind = np.where(ahead_is_seen, ahead, here), np.where(behind_is_seen, behind, here)
        with np.errstate(divide="ignore", invalid="ignore"):
            shifts[:, :, number] = (ahead - behind) / width
    return shifts


def common_covariances(pixels: Pixels, rig: Rig, laser: int = 0) -> Float[np.ndarray, "n 3 3"]:
    """Give the covariance of each point that follows from its rig's [m²].

    Memory is bounded: the shifts are never kept for all points at once.

    Args:
        pixels: Stripe centres of the points [px].
        rig: The calibrated rig, with its covariance.
        laser: Number of the laser.

    Returns:
        Covariances in the frame of `common_shifts`; NaN where a pixel sees no point, and zero
        where the rig states no covariance.
    """
    covariances = np.empty((len(pixels), 3, 3))
    for block in _blocks(len(pixels)):
        shifts = common_shifts(pixels[block], rig, laser)
        covariances[block] = shifts @ shifts.transpose(0, 2, 1)
    return covariances


def common_sigma(pixels: Pixels, rig: Rig, laser: int = 0) -> Scalars:
    """Give the common standard deviation of each point in the direction in which it is largest [m].

    That is nearly along the ray, unless a mount turns the whole ray.

    Args:
        pixels: Stripe centres of the points [px].
        rig: The calibrated rig, with its covariance.
        laser: Number of the laser.

    Returns:
        One number a point; 0 where the rig states no covariance, NaN where a pixel sees no point.
    """
    sigma = np.full(len(pixels), np.nan)
    for block in _blocks(len(pixels)):
        covariances = common_covariances(pixels[block], rig, laser)
        seen = np.isfinite(covariances).all(axis=(1, 2))
        largest = np.linalg.eigvalsh(covariances[seen])[:, -1]
        sigma[np.arange(len(pixels))[block][seen]] = np.sqrt(np.maximum(largest, 0.0))
    return sigma


def _locate(pixels: Pixels, rig: Rig, laser: int) -> Points:
    """Give the point that each pixel sees, in the frame that the rig moves with [m]."""
    index = refractive_index(rig.water, rig.wavelength)
    rays = back_project(rig.camera, pixels, index)
    points = intersect_rays_with_sheet(rays, rig.laser(laser), index)
    mount = rig.vehicle_from_camera
    return points if mount is None else mount @ points


def _blocks(count: int) -> Iterator[slice]:
    return (slice(start, start + _BLOCK) for start in range(0, count, _BLOCK))
