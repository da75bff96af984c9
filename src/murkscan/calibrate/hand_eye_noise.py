"""How photos are weighed, and what they then tell, when the log's error moves a whole photo."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from ..types.arrays import Scalars

_PER_PHOTO = 6
"""Numbers that one photo measures: where the board is, and how it is turned."""
_VAGUE = 1e3
"""Standard deviation of what nothing is known about [m], [rad], [s]."""
_LEAST = 1e-4
"""Standard deviation of a corner below which it is taken to be rounding [px]."""
_SHRINK = 6.0
"""Photos at which the correlations of a pose's errors, told from few photos, count by half."""


@dataclass(frozen=True, eq=False)
class Weighed:
    """What weighed photos tell of the parameters that are adjusted to them."""

    covariance: Float[np.ndarray, "p p"]
    """Of the parameters; about 1e6 in directions that the photos do not tell."""
    response: Float[np.ndarray, "p n"]
    """Change of the best parameters with each coordinate of a found corner."""


def weigh_photos(jacobian: Float[np.ndarray, "n p"], misfits: Scalars, num_photos: int) -> Weighed:
    """Weigh each photo by the noise of its corners and by that of its logged pose.

    The log moves all corners of a photo together, so corners do not count, photos do; and it moves
    them by some millimetres and some tenths of a degree, so a board's attitude tells more than its
    few pixels seem to. How far each photo's camera would have to move to fit its corners gives the
    covariance of the poses; what is left then, that of the corners.

    Args:
        jacobian: Change of each misfit with each parameter, photo after photo; the first six move
            the camera.
        misfits: What is left, as projected minus as found [px].
        num_photos: How many photos they are of, each with equally many.

    References:
        Aitken, On least squares and linear combination of observations, 1935, for the weights;
        Ledoit and Wolf, A well-conditioned estimator for large-dimensional covariance matrices,
        Journal of Multivariate Analysis 88(2), 2004, for leaning a covariance on its diagonal.
    """
    num_parameters = jacobian.shape[1]
    blocks = jacobian.reshape(num_photos, -1, num_parameters)
    moving = blocks[:, :, :_PER_PHOTO]
    of_a_pose, of_a_corner = _tell_noise(moving, misfits.reshape(num_photos, -1), num_parameters)
    variances, directions = np.linalg.eigh(of_a_pose)
    shaken = moving @ (directions * np.sqrt(np.maximum(variances, 0.0)))
    # The inverse of s² I + K Kᵀ by that of a 6 x 6 matrix (Woodbury).
    turned = shaken.transpose(0, 2, 1)
    inner = np.linalg.inv(of_a_corner * np.eye(_PER_PHOTO) + turned @ shaken)
    by_shaken = blocks.transpose(0, 2, 1) @ shaken
    pull = (blocks.transpose(0, 2, 1) - by_shaken @ inner @ turned) / of_a_corner
    information = (pull @ blocks).sum(axis=0) + np.eye(num_parameters) / _VAGUE**2
    covariance = np.linalg.inv(information)
    response = covariance @ np.concatenate(list(pull), axis=1)
    return Weighed((covariance + covariance.T) / 2, response)


def _tell_noise(
    moving: Float[np.ndarray, "f m 6"], left: Float[np.ndarray, "f m"], num_parameters: int
) -> tuple[Float[np.ndarray, "6 6"], float]:
    """Give the covariance of a pose, and the variance of a corner along u or v [px²]."""
    num_photos, num_numbers = left.shape
    moves = np.stack([np.linalg.lstsq(m, r)[0] for m, r in zip(moving, left, strict=True)])
    spare = max(_PER_PHOTO * num_photos - num_parameters, 1)
    covariance = moves.T @ moves * (_PER_PHOTO / spare)
    share = num_photos / (num_photos + _SHRINK)
    of_a_pose = share * covariance + (1 - share) * np.diag(np.diag(covariance))
    noise = left - np.einsum("fmi,fi->fm", moving, moves)
    of_a_corner = float(np.mean(np.sum(noise**2, axis=1))) / (num_numbers - _PER_PHOTO)
    return of_a_pose, max(of_a_corner, _LEAST**2)
