"""Means of what is alike, so that a particle among it does not count."""

import numpy as np

from .compiled import loop


@loop()
def average_alike(
    values: np.ndarray, law: np.ndarray, spreads: float, least: float
) -> tuple[np.ndarray, np.ndarray]:
    """Average each row's values that lie within the noise of their median, and count them.

    `law` holds the fixed part of the variance, its part per level and per level squared, and its
    least; within is nearer than so many of its standard deviations, or than `least`. What is NaN
    is left out; where none is left, the mean is 0 and the count 1.
    """
    rows, size = values.shape
    means, counts = np.zeros(rows), np.ones(rows)
    ordered = np.empty(size)
    for i in range(rows):
        known = 0
        for k in range(size):
            value = np.float64(values[i, k])
            if np.isnan(value):
                continue
            at = known
            while at > 0 and ordered[at - 1] > value:
                ordered[at] = ordered[at - 1]
                at -= 1
            ordered[at] = value
            known += 1
        if known == 0:
            continue
        low, high = ordered[(known - 1) // 2], ordered[known // 2]
        middle = low + 0.5 * (high - low)
        variance = max(law[0] + middle * (law[1] + middle * law[2]), law[3])
        bound = max(spreads * np.sqrt(variance), least)
        total, count = 0.0, 0
        for k in range(size):
            value = np.float64(values[i, k])
            if abs(value - middle) < bound:
                total += value
                count += 1
        counts[i] = max(count, 1)
        means[i] = total / counts[i]
    return means, counts
