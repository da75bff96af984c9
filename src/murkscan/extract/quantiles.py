"""Quantiles of what is known, where some values are not, and of what has been counted."""

import numpy as np
from jaxtyping import Float, Int

from .._kernels.counts import count_levels
from ..types.arrays import Image

Counts = Int[np.ndarray, " values"]
"""How often each whole number from 0 on is met."""


def quantiles(
    values: Float[np.ndarray, "..."], shares: tuple[float, ...], *, axis: int = 0
) -> Float[np.ndarray, "shares ..."]:
    """Give quantiles along an axis, all lines at once; `np.nanquantile` goes line by line.

    Args:
        values: What is not known is NaN; where nothing is, the quantile is.
        shares: Which quantiles, from 0 to 1.
        axis: Along which; it is kept with a length of one, as with `keepdims`.
    """
    ordered = np.sort(values, axis=axis)  # NaN comes last
    last = np.maximum(np.isfinite(values).sum(axis=axis, keepdims=True) - 1, 0)
    found = []
    for share in shares:
        place = share * last
        low = np.floor(place).astype(int)
        below = np.take_along_axis(ordered, low, axis=axis)
        above = np.take_along_axis(ordered, np.minimum(low + 1, last), axis=axis)
        found.append(below + (place - low) * (above - below))
    return np.stack(found)


def count_levels_of(image: Image) -> Counts:
    """Count how often each grey level that a picture of its depth may have is met."""
    counts = np.zeros(np.iinfo(image.dtype).max + 1, int)
    count_levels(image, counts)
    return counts


def quantile_of_counts(counts: Counts, share: float) -> float:
    """Give a quantile of what has been counted, as `np.quantile` does of the values themselves."""
    place = share * (int(counts.sum()) - 1)
    below, above = np.searchsorted(np.cumsum(counts), [np.floor(place), np.ceil(place)], "right")
    return float(below + (place - np.floor(place)) * (above - below))
