"""How much each pixel looks like the middle of a stripe, in standard deviations of the noise."""

import numpy as np

from .compiled import loop, part


@loop(fastmath=True, error_model="numpy")
def score_pixels(
    signal: np.ndarray, levels: np.ndarray, template: np.ndarray, law: np.ndarray
) -> np.ndarray:
    """Correlate each column with a template, and divide by the noise of its surroundings.

    `law` holds the fixed part of the variance, its part per level and per level squared, and its
    least; the level is the mean one of the two outer pixels on both sides of the template's window.
    Beyond its ends a column goes on as it ends.
    """
    length, num_lines = levels.shape
    size = len(template)
    half = size // 2
    fixed, gain = np.float32(law[0]), np.float32(law[1])
    relative, least = np.float32(law[2]), np.float32(law[3])
    scores = np.empty((length, num_lines), np.float32)
    total = np.empty(num_lines, np.float32)
    rim = np.empty(num_lines, np.float32)
    for v in range(length):
        total[:] = 0.0
        rim[:] = 0.0
        for k in range(size):
            at = min(max(v + k - half, 0), length - 1)
            row = signal[at]
            weight = template[k]
            for u in range(num_lines):
                total[u] += weight * row[u]
            if k < 2 or k >= size - 2:
                raw = levels[at]
                for u in range(num_lines):
                    rim[u] += np.float32(0.25) * raw[u]
        for u in range(num_lines):
            variance = max(fixed + rim[u] * (gain + rim[u] * relative), least)
            scores[v, u] = total[u] / np.sqrt(variance)
    return scores


@loop(error_model="numpy")
def add_neighbours(
    scores: np.ndarray, before: np.ndarray, after: np.ndarray, back: np.ndarray, bound: float,
    correlation: float,
) -> np.ndarray:  # fmt: skip
    """Add the scores of two other frames, by at most `bound` more than a frame's own.

    The sum has a noise of 1 as well; where it is less, a frame's own score counts. `back` has a row
    for each of the others: whether there is such a frame, and how many pixels and lines its second
    row around one of these lies further back, where it is a field of the other rows. Then its
    pixels lie half a pixel off: the scores of both are added up and scaled by `correlation`.
    """
    total = np.empty(scores.shape, np.float32)
    share = np.float32(1.0 / np.sqrt(1.0 + back[0, 0] + back[1, 0]))
    for v in range(len(scores)):
        own, row = scores[v], total[v]
        for u in range(len(own)):
            row[u] = own[u]
        if back[0, 0]:
            _add_row(own, before, v, back[0, 1], back[0, 2], bound, correlation, row)
        if back[1, 0]:
            _add_row(own, after, v, back[1, 1], back[1, 2], bound, correlation, row)
        for u in range(len(own)):
            scaled = row[u] * share
            row[u] = scaled if scaled > own[u] else own[u]
    return total


@part(error_model="numpy")
def _add_row(
    own: np.ndarray, other: np.ndarray, v: int, down: int, across: int, bound: float,
    correlation: float, row: np.ndarray,
) -> None:  # fmt: skip
    """Add a row of another frame to the sum of all."""
    # The fields of a picture with an odd number of rows differ by one.
    length, num_lines = len(other), min(len(own), other.shape[1])
    if v >= length:
        return
    near, far = other[v], other[min(max(v - down, 0), length - 1)]
    most, weight = np.float32(bound), np.float32(correlation)
    if down == 0 and across == 0:
        for u in range(num_lines):
            bounded = own[u] + most
            row[u] += near[u] if near[u] < bounded else bounded
    elif across == 0:  # the usual case by itself: several numbers at once
        for u in range(num_lines):
            both, bounded = weight * (near[u] + far[u]), own[u] + most
            row[u] += both if both < bounded else bounded
    else:
        for u in range(num_lines):
            beside = far[min(max(u - across, 0), num_lines - 1)]
            row[u] += min(weight * (near[u] + beside), own[u] + most)
