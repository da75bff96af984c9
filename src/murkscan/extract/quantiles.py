"""Quantiles of what is known, where some values are not."""

import numpy as np
from jaxtyping import Float


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
