"""The covariance of a rig with its new mount: what the camera does not know, the mount does not."""

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from ..optics import perturb_rig, refractive_index
from ..types.arrays import Vector
from ..types.pose import Pose
from ..types.rig import Rig
from ..types.rig_covariance import RigCovariance
from .hand_eye_fit import HandEyeFit, HandEyeProblem, move

MOUNT_PARAMETERS = tuple(f"mount.{part}[{i}]" for part in ("translation", "turn") for i in range(3))
"""Names of a mount's parameters; see `perturb_rig`."""
_FRACTION = 0.1
"""Step of a parameter for a derivative, in its standard deviations: as far as it matters."""


def join_covariance(rig: Rig, problem: HandEyeProblem, fit: HandEyeFit) -> RigCovariance:
    """Give the covariance of a rig's parameters and of its new mount.

    The mount was told with the camera taken as known, so it shares the camera's errors.

    Args:
        rig: The rig that took the photos; an older mount of it is forgotten.
        problem: What was adjusted.
        fit: The mount.
    """
    others = rig.covariance.without("mount.")
    slopes = fit.response @ -_derivatives(replace(rig, covariance=others), problem, fit)
    shared = slopes @ others.matrix
    matrix = np.block(
        [[others.matrix, shared.T], [shared, fit.mount_covariance + shared @ slopes.T]]
    )
    return RigCovariance(others.names + MOUNT_PARAMETERS, (matrix + matrix.T) / 2)


def pull_to_measured(
    mount: Pose, covariance: RigCovariance, translation: Vector, sigma: float
) -> tuple[Pose, RigCovariance]:
    """Give a mount and a rig's covariance with a measured place of the camera in them.

    Args:
        mount: vehicle_from_camera.
        covariance: Of the rig, its mount's parameters last.
        translation: The measured place of the camera on the vehicle [m].
        sigma: Its standard deviation [m].

    References:
        Bucy and Joseph, Filtering for stochastic processes, 1968, for the form of the update that
        holds for any gain: the rig's other parameters stay what they are.
    """
    own = covariance.matrix[-6:, -6:]
    noise = sigma**2 * np.eye(3)
    gain = np.zeros((len(covariance.names), 3))
    gain[-6:] = own[:, :3] @ np.linalg.inv(own[:3, :3] + noise)
    rest = np.eye(len(gain))
    rest[:, -6:-3] -= gain
    matrix = rest @ covariance.matrix @ rest.T + gain @ noise @ gain.T
    moved = move(mount, gain[-6:] @ (translation - mount.translation))
    return moved, RigCovariance(covariance.names, (matrix + matrix.T) / 2)


def _derivatives(rig: Rig, problem: HandEyeProblem, fit: HandEyeFit) -> Float[np.ndarray, "n m"]:
    """Give the change of the misfits with each parameter that the covariance names."""
    columns = []
    for name, sigma in zip(rig.covariance.names, rig.covariance.sigma, strict=True):
        sides = []
        for step in (_FRACTION * sigma, -_FRACTION * sigma):
            other = perturb_rig(rig, [name], np.array([step]))
            index = refractive_index(other.water, other.wavelength)
            sides.append(replace(problem, camera=other.camera, index=index).misfits_of(fit))
        step = 2 * _FRACTION * sigma
        columns.append((sides[0] - sides[1]) / step if step > 0 else np.zeros_like(sides[0]))
    return np.stack(columns, axis=1) if columns else np.zeros((fit.response.shape[1], 0))
