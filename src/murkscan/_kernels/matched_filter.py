"""How much each pixel looks like the middle of a stripe, in standard deviations of the noise."""

import numpy as np

from .compiled import loop


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


@loop(fastmath=True, error_model="numpy")
def add_neighbour(
    scores: np.ndarray, other: np.ndarray, down: int, across: int, bound: float, correlation: float,
    total: np.ndarray,
) -> None:  # fmt: skip
    """Add the scores of another frame, by at most `bound` more than a frame's own.

    Where the other frame is a field of the other rows, its pixels lie half a pixel off: then the
    scores there and (down, across) further back are added up and scaled by `correlation`.
    """
    # The fields of a picture with an odd number of rows differ by one.
    length = min(scores.shape[0], other.shape[0])
    num_lines = min(scores.shape[1], other.shape[1])
    for v in range(length):
        near = other[v]
        far = other[min(max(v - down, 0), length - 1)]
        if down == 0 and across == 0:
            for u in range(num_lines):
                total[v, u] += min(near[u], scores[v, u] + np.float32(bound))
        else:
            for u in range(num_lines):
                beside = far[min(max(u - across, 0), num_lines - 1)]
                mean = np.float32(correlation) * (near[u] + beside)
                total[v, u] += min(mean, scores[v, u] + np.float32(bound))
