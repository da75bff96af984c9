"""How much each residual counts: noise told from the residuals themselves, outliers held off."""

from dataclasses import dataclass

import numpy as np

from .linearise import Linearised, Rows

_BENT, _OFF = 5.0, 10.0
"""Standard deviations from which a residual counts less and less, and from which not at all."""
_RAYLEIGH, _GAUSSIAN = 1 / 1.1774, 1.4826
"""Standard deviation over the median length of a 2-D error, and over the median size of a 1-D one.
"""
_FLOOR = 1e-6
"""Least noise that is believed in [px]; without noise there is nothing to divide by."""


@dataclass(frozen=True, eq=False)
class Weights:
    """Noise of both kinds of residuals, and what each row is worth."""

    corner_sigma: float
    """Standard deviation of a corner along u or v [px]."""
    stripe_sigma: float
    """Standard deviation of a stripe point across the stripe [px]."""
    shares: Rows
    """1 for a residual that fits, less beyond 5 standard deviations, 0 beyond 10."""
    num_corner_rows: int
    dispersion: float
    """How much less all of them tell than their noise promises, as a ratio of variances."""

    @property
    def roots(self) -> Rows:
        """Square root of each row's weight [1/px]."""
        sigma = np.full(len(self.shares), self.stripe_sigma)
        sigma[: self.num_corner_rows] = self.corner_sigma
        return np.sqrt(self.shares / self.dispersion) / sigma


def weigh(
    found: Linearised, *, num_photos: int, num_laser_parameters: int, dispersion: float
) -> Weights:
    """Tell the noise from the residuals, and weigh each by how far it stands out.

    References:
        Huber, Robust Statistics, 1981, chapter 7, for iterative reweighting; Hampel, Ronchetti,
        Rousseeuw and Stahel, Robust Statistics, 1986, section 2.6, for letting go of outliers.
    """
    split = found.num_corner_rows
    lengths = np.hypot(*found.residuals[:split].reshape(-1, 2).T)
    stripe = np.abs(found.residuals[split:])
    corner_shares = np.repeat(_shares(lengths, _RAYLEIGH * _median(lengths)), 2)
    stripe_shares = _shares(stripe, _GAUSSIAN * _median(stripe))
    free = found.by_rig.shape[1] - num_laser_parameters + 6 * num_photos
    return Weights(
        _rms(found.residuals[:split], corner_shares, free),
        _rms(found.residuals[split:], stripe_shares, num_laser_parameters),
        np.concatenate([corner_shares, stripe_shares]),
        split,
        dispersion,
    )


def _shares(sizes: Rows, sigma: float) -> Rows:
    far = sizes / max(sigma, _FLOOR)
    return np.where(far > _OFF, 0.0, _BENT / np.maximum(far, _BENT))


def _median(sizes: Rows) -> float:
    return float(np.median(sizes)) if len(sizes) else 0.0


def _rms(residuals: Rows, shares: Rows, num_parameters: int) -> float:
    """Give the standard deviation of residuals from which parameters have been fitted."""
    rest = max(float(shares.sum()) - num_parameters, 1.0)
    return max(float(np.sqrt(np.sum(shares * residuals**2) / rest)), _FLOOR)
