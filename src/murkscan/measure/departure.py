"""What a scan's deviations amount to."""

import math

import numpy as np

from ..geometry.correlated_errors import covariance_of_sums
from ..types.arrays import Scalars
from ..types.deviation import Deviation
from ..types.measurement import Measurement
from ..types.quantity import Quantity
from .sample import Sample

_MOST_SHIFTED = 2000
"""Points for which the rig's errors are traced."""
_EXTREMES = (1.0, 99.0)
"""Percent of the points below which the lowest and the highest deviations are told."""


def sigma_of_points(sample: Sample, deviation: Deviation) -> Scalars:
    """Give the standard deviation of each distance, without what the scan shares [m]."""
    facing = np.ones(len(sample))
    if sample.sight is not None:
        facing = np.abs(np.einsum("ij,ij->i", sample.sight.rays, deviation.normals))
    return np.hypot(sample.cloud.sigma * facing, deviation.sigma_reference)


def measure_departure(sample: Sample, deviation: Deviation) -> Measurement:
    """Give mean, RMS and extremes of a scan's distances from a reference.

    Args:
        sample: The scan's points.
        deviation: Their distances from the reference.
    """
    known = np.isfinite(deviation.values)
    total = len(sample)
    sample, deviation = sample[known], deviation[known]
    values, count = deviation.values, len(deviation)
    reference = float(np.sqrt(np.mean(deviation.sigma_reference**2)))
    errors = values - values.mean()
    own = covariance_of_sums(np.full((count, 1), 1 / count), errors, sample.profile, sample.line)
    mean_sigma = math.sqrt(float(own[0, 0]))
    spread = max(float(values.std()), 1e-12)
    patches = max((spread / mean_sigma) ** 2 if mean_sigma > 0 else count, 2.0)
    common = _mean_shift(sample, deviation)
    rms = float(np.sqrt(np.mean(values**2)))
    found = [
        _quantity("mean", float(values.mean()), mean_sigma, reference, common, patches),
        _quantity("rms", rms, rms / math.sqrt(2 * patches), reference, common, patches),
    ]
    for share, name in zip(_EXTREMES, ("lowest_1_percent", "highest_1_percent"), strict=True):
        value, sigma = _percentile(values, share, patches)
        found.append(_quantity(name, value, sigma, reference, common, patches))
    details = {"points": total, "compared": count, "independent_patches": round(patches)}
    return Measurement("deviation", tuple(found), details)


def _quantity(
    name: str, value: float, own: float, reference: float, common: float | None, patches: float
) -> Quantity:
    return Quantity(name, value, "m", math.hypot(own, reference), common, max(patches - 1, 1.0))


def _percentile(values: Scalars, share: float, patches: float) -> tuple[float, float]:
    """Give a percentile, and its deviation for so many independent values.

    References:
        David and Nagaraja, Order Statistics, 3rd edition, 2003, section 10.2.
    """
    low, value, high = np.percentile(values, [share - 0.5, share, share + 0.5])
    slope = (high - low) / 0.01
    part = share / 100
    return float(value), float(slope * math.sqrt(part * (1 - part) / patches))


def _mean_shift(sample: Sample, deviation: Deviation) -> float | None:
    """Give how far the rig's errors move all points together along their normals [m]."""
    if sample.shifts is None:
        return None
    some = np.arange(len(sample))[:: max(len(sample) // _MOST_SHIFTED, 1)]
    outwards = np.einsum("ij,ijm->im", deviation.normals[some], sample.shifts(some))
    return float(np.linalg.norm(np.nanmean(outwards, axis=0)))
