"""Centres of mass around peaks."""

import numpy as np
from numba import njit

_SIDE = 5
"""Pixels on one side of a peak that give the background there."""


@njit(cache=True, nogil=True)
def side_level(scan: np.ndarray, peak: int, way: int, half_width: int) -> tuple[float, float]:
    """Mean level on one side of a peak, and how far away it was taken.

    Just beyond the window or just within its end, whichever is darker: another stripe may lie at
    either.
    """
    level, distance = np.inf, 0.0
    for start in (half_width + 1, max(half_width + 1 - _SIDE, 1)):
        mean, count = 0.0, 0
        for k in range(_SIDE):
            v = peak + way * (start + k)
            if 0 <= v < len(scan):
                mean += scan[v]
                count += 1
        if count > 0 and mean / count < level:
            level, distance = mean / count, start + (count - 1) / 2
    return (level, distance) if distance > 0 else (float(scan[peak]), 1.0)


@njit(cache=True, nogil=True)
def weigh_peaks(
    image: np.ndarray,
    peaks: np.ndarray,
    down: bool,
    half_width: int,
    foot: float,
    least: float,
    noise: float,
) -> np.ndarray:
    """Centre of mass of what each peak shows above its foot.

    The background is the line through the levels on both sides of the peak; the foot lies
    above it by a share of the peak's height. The window ends where the stripe first sinks below its
    foot, between two pixels.

    Scan lines are image columns if `down`, otherwise image rows. Gives centre, its standard
    deviation, height over background, one peak a row (n 3); NaN where it is less than `least` high.
    """
    found = np.full((len(peaks), 3), np.nan)
    for i in range(len(peaks)):
        line, peak = peaks[i]
        scan = image[:, line] if down else image[line]
        low, high = max(peak - half_width, 0), min(peak + half_width + 1, len(scan))
        left, before = side_level(scan, peak, -1, half_width)
        right, after = side_level(scan, peak, 1, half_width)
        slope = (right - left) / (before + after)
        base = left + slope * before
        height = scan[peak] - base
        # The peak's own pixel holds light from all of its width: a twelfth of a square pixel.
        mass, moment, spread = 0.0, 0.0, 1.0 / 12.0
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
        if mass > 0 and height >= least:
            shift = moment / mass
            # How far the background's slope is uncertain, and how far that moves the centre.
            tilt = spread * np.sqrt(2.0 / _SIDE) / (before + after)
            found[i, 0] = peak + shift
            found[i, 1] = noise * np.sqrt(spread + tilt**2) / mass
            found[i, 2] = height
    return found
