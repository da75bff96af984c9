"""How many of many numbers lie where: what a distribution's picture is drawn from."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..types.arrays import Scalars

_BINS = 40
_ENDS = (0.002, 0.998)
"""Quantiles between which the bins lie; the few beyond are told as such."""


@dataclass(frozen=True, eq=False)
class Histogram:
    """Shares of the numbers in bins of equal width, or of equal ratio."""

    edges: Scalars
    """Ends of the bins, one more than there are bins; none without numbers."""
    shares: Scalars
    """Share of the numbers in each bin."""
    below: float
    """Share below the first bin."""
    above: float
    """Share above the last bin."""

    @classmethod
    def from_values(cls, values: Scalars) -> "Histogram":
        """Sort numbers into bins of equal width; those that are not finite do not count."""
        return cls._of(values[np.isfinite(values)], np.linspace)

    @classmethod
    def from_ratios(cls, values: Scalars) -> "Histogram":
        """Sort numbers above 0 into bins of equal ratio."""
        return cls._of(values[np.isfinite(values) & (values > 0)], np.geomspace)

    @classmethod
    def _of(cls, values: Scalars, space: Callable[[float, float, int], Scalars]) -> "Histogram":
        if not len(values):
            return cls(np.zeros(0), np.zeros(0), 0.0, 0.0)
        low, high = np.quantile(values, _ENDS)
        if not high > low:
            low, high = low - 0.5 * abs(low) - 1e-12, low + 0.5 * abs(low) + 1e-12
        edges = space(low, high, _BINS + 1)
        counts, _ = np.histogram(values, edges)
        below, above = np.mean(values < edges[0]), np.mean(values > edges[-1])
        return cls(edges, counts / len(values), float(below), float(above))
