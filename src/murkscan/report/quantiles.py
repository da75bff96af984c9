"""How numbers are spread: what a report says instead of a list of them."""

from dataclasses import dataclass

import numpy as np

from ..types.arrays import Ratios, Scalars

_LOW, _HIGH = 0.05, 0.95


@dataclass(frozen=True)
class Quantiles:
    """Five figures for many numbers; each None where there are no numbers."""

    smallest: float | None
    low: float | None
    """5 % are smaller."""
    median: float | None
    high: float | None
    """95 % are smaller."""
    largest: float | None

    @classmethod
    def from_values(cls, values: Scalars | Ratios) -> "Quantiles":
        """Summarise numbers; those that are not finite do not count."""
        finite = np.sort(values[np.isfinite(values)])
        if not len(finite):
            return cls(None, None, None, None, None)
        low, median, high = np.quantile(finite, [_LOW, 0.5, _HIGH])
        return cls(float(finite[0]), float(low), float(median), float(high), float(finite[-1]))
