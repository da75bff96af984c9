"""What a scan's deviations amount to."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..geometry.correlated_errors import variance_of_sum
from ..types.arrays import Scalars
from ..types.deviation import Deviation
from ..types.measurement import Measurement
from ..types.plane import span_plane
from ..types.quantity import Quantity
from .height_errors import HeightErrors, find_height_errors
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
    """Measure mean, RMS and extremes of a scan's distances from a reference.

    Their intervals hold what the points' noise leaves open, as far as it hangs together. What the
    surface itself departs by is no noise, and widens none of them.

    Args:
        sample: The scan's points.
        deviation: Their distances from the reference.
    """
    known = np.isfinite(deviation.values)
    total = len(sample)
    sample, deviation = sample[known], deviation[known]
    values, count = deviation.values, len(deviation)
    open_by = _Open.of(sample, deviation)
    mean, rms = float(values.mean()), float(np.sqrt(np.mean(values**2)))
    # The mean of a Gaussian error's square varies by half of what its product with another would.
    tells = values - (1 - math.sqrt(0.5)) * open_by.errors.values
    found = [
        open_by.quantity("mean", mean, open_by.sigma(np.full(count, 1 / count))),
        open_by.quantity("rms", rms, open_by.sigma(tells / (count * max(rms, 1e-12)))),
    ]
    for share, name in zip(_EXTREMES, ("lowest_1_percent", "highest_1_percent"), strict=True):
        found.append(_percentile(name, values, share, open_by))
    details = {"points": total, "compared": count, "independent_patches": round(open_by.patches)}
    return Measurement("deviation", tuple(found), details)


@dataclass(frozen=True, eq=False)
class _Open:
    """What is open of a scan's distances."""

    sample: Sample
    errors: HeightErrors
    noise: float
    """Standard deviation of a point [m]."""
    reference: float
    """Standard deviation of the reference's place [m]."""
    common: float | None
    """How far the rig's errors move all points together [m]."""

    @classmethod
    def of(cls, sample: Sample, deviation: Deviation) -> "_Open":
        """Leave of the distances what no smooth map of them follows."""
        up = deviation.normals.sum(axis=0)
        sides = span_plane(up / max(float(np.linalg.norm(up)), 1e-300))
        places = sample.cloud.points @ sides.T
        noise = sample.usual_noise
        errors = find_height_errors(
            np.column_stack([places, deviation.values]), np.array([0.0, 0.0, 1.0]), noise=noise
        )
        reference = float(np.sqrt(np.mean(deviation.sigma_reference**2)))
        return cls(sample, errors, noise, reference, _mean_shift(sample, deviation))

    def sigma(self, weights: Scalars) -> float:
        """Compute the standard deviation of a weighted sum of the distances [m]."""
        numbers = self.sample.profile, self.sample.line
        return math.sqrt(self.errors.variance_of_sum(weights, *numbers, noise=self.noise))

    @cached_property
    def patches(self) -> float:
        """Count the patches of points that err on their own."""
        count = len(self.sample)
        alone = float(self.errors.values.std()) / max(self.sigma(np.full(count, 1 / count)), 1e-300)
        return min(max(alone**2, 2.0), float(count))

    def quantity(
        self, name: str, value: float, own: float, degrees: float | None = None
    ) -> Quantity:
        """Put a number [m] and its own deviation beside what else is open."""
        sigma = math.hypot(own, self.reference)
        degrees = self.patches - 1 if degrees is None else degrees
        return Quantity(name, value, "m", sigma, self.common, max(degrees, 1.0))


def _percentile(name: str, values: Scalars, share: float, open_by: _Open) -> Quantity:
    """Compute a percentile.

    Where distances are the points' noise, it is open how many patches lie beyond; where they are
    the surface's own, how the points about there err. The smaller one is the one that counts.

    References:
        David and Nagaraja, Order Statistics, 3rd edition, 2003, section 10.2.
    """
    low, value, high = np.percentile(values, [share - 0.5, share, share + 0.5]).tolist()
    below, alike = values < value, np.full(len(values), 1 / len(values))
    numbers = open_by.sample.profile, open_by.sample.line
    variance = variance_of_sum(alike, below - below.mean(), *numbers)
    by_chance = (high - low) / 0.01 * math.sqrt(variance)
    about = ((values >= low) & (values <= high)).astype(float)
    together = open_by.sigma(about / about.sum())
    if together < by_chance:
        return open_by.quantity(name, value, together)
    beyond = min(share, 100 - share) / 100
    return open_by.quantity(name, value, by_chance, beyond**2 / max(variance, 1e-300))


def _mean_shift(sample: Sample, deviation: Deviation) -> float | None:
    """Give how far the rig's errors move all points together along their normals [m]."""
    if sample.shifts is None:
        return None
    some = np.arange(len(sample))[:: max(len(sample) // _MOST_SHIFTED, 1)]
    outwards = np.einsum("ij,ijm->im", deviation.normals[some], sample.shifts(some))
    return float(np.linalg.norm(np.nanmean(outwards, axis=0)))
