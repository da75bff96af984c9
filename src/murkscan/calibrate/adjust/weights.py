"""How much each residual counts: noise told from the residuals themselves, outliers held off."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from .residuals import Linearised, Rows, is_of_stand

_BENT, _OFF = 5.0, 10.0
"""Standard deviations from which a residual counts less and less, and from which not at all."""
_RAYLEIGH, _GAUSSIAN = 1 / 1.1774, 1.4826
"""Standard deviation over the median length of a 2-D error, and over the median size of a 1-D one.
"""
_FLOOR = 1e-6
"""Least noise that is believed in [px]; without noise there is nothing to divide by."""
_POSE_FLOOR = 1e-6
"""The same of a logged pose [m], [rad]."""
_SHRINK = 6.0
"""Photos at which the correlations of a pose's errors, told from few photos, count by half."""

Square = Float[np.ndarray, "6 6"]


@dataclass(frozen=True, eq=False)
class Weights:
    """Noise of all kinds of residuals, and what each row is worth."""

    corner_sigma: float
    """Standard deviation of a corner along u or v [px]."""
    stripe_sigma: float
    """Standard deviation of a stripe point across the stripe [px]."""
    shares: Rows
    """1 for a residual that fits, less beyond 5 standard deviations, 0 beyond 10; of corners and
    stripe points."""
    num_corner_rows: int
    dispersion: float
    """How much less all of them tell than their noise promises, as a ratio of variances."""
    pose_noise: Square
    """Covariance of a logged pose: of its shift along the vehicle's axes [m] and its turn about
    the camera's [rad]."""

    def weigh(self, rows: Float[np.ndarray, "..."]) -> Float[np.ndarray, "..."]:
        """Scale rows to unit variance, and by what each is worth."""
        sigma = np.full(len(self.shares), self.stripe_sigma)
        sigma[: self.num_corner_rows] = self.corner_sigma
        roots = np.sqrt(self.shares / self.dispersion) / sigma
        seen, logged = rows[: len(roots)], rows[len(roots) :]
        whiten = np.linalg.inv(np.linalg.cholesky(self.pose_noise)) / np.sqrt(self.dispersion)
        poses = logged.reshape(-1, 6, *rows.shape[1:])
        white = np.einsum("ij,pj...->pi...", whiten, poses).reshape(logged.shape)
        return np.concatenate([(roots * seen.T).T, white])


def weigh(found: Linearised, *, num_photos: int, dispersion: float) -> Weights:
    """Tell the noise from the residuals, and weigh each by how far it stands out.

    References:
        Huber, Robust Statistics, 1981, chapter 7, for iterative reweighting; Hampel, Ronchetti,
        Rousseeuw and Stahel, Robust Statistics, 1986, section 2.6, for letting go of outliers.
    """
    split, end = found.num_corner_rows, len(found.residuals) - found.num_log_rows
    corners, stripe = found.residuals[:split], np.abs(found.residuals[split:end])
    lengths = np.hypot(*corners.reshape(-1, 2).T)
    corner_shares = np.repeat(_shares(lengths, _RAYLEIGH * _median(lengths)), 2)
    stripe_shares = _shares(stripe, _GAUSSIAN * _median(stripe))
    of_laser = sum(name.startswith("laser[") for name in found.names)
    of_log = sum(is_of_stand(name) or name.startswith("mount.") for name in found.names)
    free = len(found.names) - of_laser - of_log + 6 * num_photos
    corner_sigma = _rms(corners, corner_shares, free)
    return Weights(
        corner_sigma,
        _rms(stripe, stripe_shares, of_laser),
        np.concatenate([corner_shares, stripe_shares]),
        split,
        dispersion,
        _pose_noise(found, np.sqrt(corner_shares) / corner_sigma, of_log),
    )


def _pose_noise(found: Linearised, roots: Rows, num_parameters: int) -> Square:
    """Tell the covariance of logged poses by how far each photo's corners are from them.

    The log moves all corners of a photo together, and it moves them by some millimetres and some
    tenths of a degree, so a board's attitude tells more than its few pixels seem to.

    References:
        Ledoit and Wolf, A well-conditioned estimator for large-dimensional covariance matrices,
        Journal of Multivariate Analysis 88(2), 2004, for leaning a covariance on its diagonal.
    """
    if found.num_log_rows == 0:
        return np.eye(6)
    num_photos, split = found.num_log_rows // 6, found.num_corner_rows
    logged = found.residuals[-found.num_log_rows :].reshape(-1, 6)
    slopes = found.by_pose[-found.num_log_rows :].reshape(-1, 6, 6)
    by_pose, residuals = roots[:, None] * found.by_pose[:split], roots * found.residuals[:split]
    alone = []
    for photo in range(num_photos):
        mine = found.photo[:split] == photo
        step = np.linalg.lstsq(by_pose[mine], -residuals[mine], rcond=None)[0]
        alone.append(logged[photo] + slopes[photo] @ step)
    spare = max(6 * num_photos - num_parameters, 1)
    covariance = np.transpose(alone) @ np.array(alone) * (6 / spare)
    share = num_photos / (num_photos + _SHRINK)
    leaned = share * covariance + (1 - share) * np.diag(np.diag(covariance))
    return leaned + _POSE_FLOOR**2 * np.eye(6)


def _shares(sizes: Rows, sigma: float) -> Rows:
    far = sizes / max(sigma, _FLOOR)
    return np.where(far > _OFF, 0.0, _BENT / np.maximum(far, _BENT))


def _median(sizes: Rows) -> float:
    return float(np.median(sizes)) if len(sizes) else 0.0


def _rms(residuals: Rows, shares: Rows, num_parameters: int) -> float:
    """Give the standard deviation of residuals from which parameters have been fitted."""
    rest = max(float(shares.sum()) - num_parameters, 1.0)
    return max(float(np.sqrt(np.sum(shares * residuals**2) / rest)), _FLOOR)
