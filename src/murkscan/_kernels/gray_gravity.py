"""Centres of mass around peaks."""

import numpy as np
from numba import njit

_SIDE = 5
"""Pixels beyond each end of the window that give the background."""


@njit(cache=True, nogil=True, inline="always")
def side_means(scan: np.ndarray, low: int, high: int) -> tuple[float, float, int]:
    """Mean levels of the first and of the last pixels of a stretch, and how many each is of."""
    count = max(min(_SIDE, (high - low) // 3), 1)
    left, right = 0.0, 0.0
    for k in range(count):
        left += scan[low + k] / count
        right += scan[high - 1 - k] / count
    return left, right, count


@njit(cache=True, nogil=True)
def weigh_peaks(
    image: np.ndarray, peaks: np.ndarray, down: bool, half_width: int, foot: float, noise: float
) -> np.ndarray:
    """Centre of mass of what each peak shows above its foot.

    The background is the line through the mean levels on both sides of the window; the foot lies
    above it by a share of the peak's height. The window ends where the stripe first sinks below its
    foot, between two pixels.

    Scan lines are image columns if `down`, otherwise image rows. Gives centre, its standard
    deviation, height over background, one peak a row (n 3); NaN where nothing rises above the foot.
    """
    found = np.full((len(peaks), 3), np.nan)
    for i in range(len(peaks)):
        line, peak = peaks[i]
        scan = image[:, line] if down else image[line]
        low, high = max(peak - half_width - _SIDE, 0), min(peak + half_width + _SIDE + 1, len(scan))
        left, right, count = side_means(scan, low, high)
        span = max(high - low - count, 1)
        slope = (right - left) / span
        base = left + slope * (peak - low - (count - 1) / 2)
        height = scan[peak] - base
        mass, moment, spread = 0.0, 0.0, 0.0
        for way in (-1, 1):
            reached, weight = 0, (1.0 - foot) * height
            while reached < half_width and weight > 0:
                v = peak + way * (reached + 1)
                beyond = -1.0
                if low <= v < high:
                    beyond = scan[v] - base - slope * (v - peak) - foot * height
                # Between pixels the stripe is a straight line: this piece of it is a trapezium, or
                # a triangle where it ends. Whole pixels would pull the centre to their middles.
                share = 1.0 if beyond > 0 else weight / (weight - beyond)
                near, far = 0.5 * share * weight, 0.5 * share * max(beyond, 0.0)
                at = way * (reached + (0.0 if beyond > 0 else share / 3))
                mass += near + far
                moment += near * at + far * way * (reached + 1)
                spread += reached**2
                reached, weight = reached + 1, beyond
        if mass > 0:
            shift = moment / mass
            # How far the background's slope is uncertain, and how far that moves the centre.
            tilt = spread * np.sqrt(2.0 / count) / span
            found[i, 0] = peak + shift
            found[i, 1] = noise * np.sqrt(spread + tilt**2) / mass
            found[i, 2] = height
    return found
