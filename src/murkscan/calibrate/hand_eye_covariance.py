"""How well an adjustment knows its parameters when each photo is one measurement."""

import numpy as np
from jaxtyping import Float

from ..types.arrays import Scalars

_PER_PHOTO = 6
"""Numbers that one photo measures: where the board is, and how it is turned."""
_VAGUE = 1e3
"""Standard deviation of what nothing is known about [m], [rad], [s]."""


def covariance_of(
    jacobian: Float[np.ndarray, "n m"], misfits: Scalars, num_photos: int
) -> Float[np.ndarray, "m m"]:
    """Give the covariance of adjusted parameters.

    The log's pose of a photo moves all its corners together, so corners do not count, photos do.
    How far each photo's camera would have to move to fit its corners gives the covariance of the
    poses, and that the covariance of what was adjusted to them.

    Args:
        jacobian: Change of each misfit with each parameter, photo after photo; the first six move
            the camera.
        misfits: What is left [px].
        num_photos: How many photos they are of, each with equally many.

    Returns:
        The covariance; about 1e6 in directions that the photos do not tell.

    References:
        Cameron and Miller, A practitioner's guide to cluster-robust inference, Journal of Human
        Resources 50(2), 2015, equation (11), with one covariance for all clusters.
    """
    num_parameters = jacobian.shape[1]
    blocks = jacobian.reshape(num_photos, -1, num_parameters)
    moving = blocks[:, :, :_PER_PHOTO]
    left = misfits.reshape(num_photos, -1)
    moves = np.stack([np.linalg.lstsq(m, r)[0] for m, r in zip(moving, left, strict=True)])
    spare = max(_PER_PHOTO * num_photos - num_parameters, 1)
    of_a_pose = moves.T @ moves * (_PER_PHOTO / spare)
    pull = np.einsum("fij,fik->fjk", blocks, moving)
    spread = np.einsum("fij,jk,flk->il", pull, of_a_pose, pull)
    # A floor, so that data without noise do not give an information without bounds.
    unit = max(float(misfits @ misfits) / spare, 1e-12)
    vague = np.eye(num_parameters) / _VAGUE**2
    inverse = np.linalg.inv(jacobian.T @ jacobian / unit + vague)
    return inverse @ (spread / unit**2 + vague) @ inverse
