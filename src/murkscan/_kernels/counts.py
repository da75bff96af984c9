"""How often whole numbers are met: grey levels, and their differences in and between pictures."""

import numpy as np

from .compiled import loop


@loop()
def count_levels(image: np.ndarray, counts: np.ndarray) -> None:
    """Add to `counts` how often each grey level is met."""
    for v in range(image.shape[0]):
        for u in range(image.shape[1]):
            counts[image[v, u]] += 1


@loop()
def count_bends(image: np.ndarray, apart: int, every: int, counts: np.ndarray) -> None:
    """Add to `counts` the sizes of second differences of pixels `apart`, of every so many rows."""
    for v in range(0, image.shape[0], every):
        for u in range(image.shape[1] - 2 * apart):
            ends = np.int64(image[v, u]) + np.int64(image[v, u + 2 * apart])
            counts[abs(ends - 2 * np.int64(image[v, u + apart]))] += 1


@loop()
def count_changes(first: np.ndarray, second: np.ndarray, every: int, counts: np.ndarray) -> None:
    """Add to `counts` the sizes of the differences of two pictures, of every so many rows."""
    for v in range(0, first.shape[0], every):
        for u in range(first.shape[1]):
            counts[abs(np.int64(second[v, u]) - np.int64(first[v, u]))] += 1


@loop()
def list_fourth_differences(
    image: np.ndarray, lag: int, every: int
) -> tuple[np.ndarray, np.ndarray]:
    """List five times the mean level, and the fourth difference, of pixels `lag` apart in a row.

    Of every so many rows, at every second pixel.
    """
    rows, columns = (image.shape[0] + every - 1) // every, (image.shape[1] - 4 * lag + 1) // 2
    levels = np.empty(max(rows * columns, 0), np.int32)
    bends = np.empty(len(levels), np.int32)
    i = 0
    for v in range(0, image.shape[0], every):
        for k in range(columns):
            u = 2 * k
            a, e = np.int32(image[v, u]), np.int32(image[v, u + 4 * lag])
            b, d = np.int32(image[v, u + lag]), np.int32(image[v, u + 3 * lag])
            c = np.int32(image[v, u + 2 * lag])
            levels[i], bends[i] = a + b + c + d + e, a - 4 * b + 6 * c - 4 * d + e
            i += 1
    return levels, bends


@loop()
def sort_by(keys: np.ndarray, values: np.ndarray, most: int) -> tuple[np.ndarray, np.ndarray]:
    """Sort values by their keys, whole numbers from 0 to `most`; those of equal keys keep order."""
    starts = np.zeros(most + 2, np.int64)
    for key in keys:
        starts[key + 1] += 1
    for key in range(most + 1):
        starts[key + 1] += starts[key]
    ordered, out = np.empty_like(keys), np.empty_like(values)
    for i in range(len(keys)):
        place = starts[keys[i]]
        ordered[place], out[place] = keys[i], values[i]
        starts[keys[i]] += 1
    return ordered, out


@loop(fastmath=True)
def winsorise(values: np.ndarray, close: float, left: float, turns: int) -> float:
    """Compute the variance of whole numbers around 0 with far ones pulled in, again and again.

    What is beyond `close` standard deviations counts as it were there; `left` is what that leaves
    of the variance of a Gaussian.
    """
    total = 0.0
    for value in values:
        total += np.float64(value) * np.float64(value)
    variance = total / len(values)
    for _ in range(turns):
        most = close * close * variance
        total = 0.0
        for value in values:
            total += min(np.float64(value) * np.float64(value), most)
        variance = total / len(values) / left
    return variance
