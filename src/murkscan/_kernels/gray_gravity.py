"""Centres of mass around peaks."""

import numpy as np

from .compiled import loop, part

_SIDE = 5
"""Pixels on one side of a peak that give the background there."""
_NARROWEST = 2.9
"""Width that the narrowest stripe is taken to have at its foot [px]: one that is half a pixel wide
(1σ) is weighed alike wherever in its pixel it lies, to 0.012 px."""
_REACH = 1.9
"""Reach of the window to either side, in widths of the stripe at its foot."""
_BLIND = 11.0 / 3.0
"""What makes a window of this form, (1 - x²)³ x (1 - 11/3 x²), blind to light with an even slope:
its integral times x is 0."""
_TURNS = 4
"""Times that the window is laid anew on its own centre, which halves what is left ten times."""


@part()
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


@loop()
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
    above it by a share of the peak's height. Each pixel is weighed by a window without edges, whose
    reach follows from the stripe's width at its foot, and which lies on the centre that it gives: a
    window with edges pulls the centre by up to 0.2 px to where in its pixel an edge lies. It is
    blind to light with an even slope: what the water scatters forward lies under the stripe as a
    skirt of many pixels, is other scan lines' light as well, and lies beside the stripe where the
    surface bends.

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
        width = 0.0
        for way in (-1, 1):
            reached, weight = 0, (1.0 - foot) * height
            while reached < half_width and weight > 0:
                v = peak + way * (reached + 1)
                beyond = -1.0
                if low <= v < high:
                    beyond = scan[v] - base - slope * (v - peak) - foot * height
                # Between pixels the stripe is a straight line, also where it ends.
                width += 1.0 if beyond > 0 else weight / (weight - beyond)
                reached, weight = reached + 1, beyond
        if height >= least:
            reach = _REACH * min(max(width, _NARROWEST), half_width + 0.5)
            shift, spread = _weigh(
                scan, peak, base, slope, reach, 2 / _SIDE / (before + after) ** 2
            )
            if abs(shift) <= 0.4 * reach and spread > 0:
                found[i, 0] = peak + shift
                found[i, 1] = noise * spread
                found[i, 2] = height
    return found


@part()
def _weigh(
    scan: np.ndarray, peak: int, base: float, slope: float, reach: float, tilt: float
) -> tuple[float, float]:
    """Give the centre in a window that lies on it, from the peak, and its deviation over noise.

    The window is that of `_BLIND`, where x is the distance over the reach, beyond which it is zero;
    `tilt` is the variance of the background's slope over that of a pixel. Deviation 0: there is no
    centre.
    """
    shift, deviation = 0.0, 0.0
    for _ in range(_TURNS):
        low = max(peak + int(np.ceil(shift - reach)), 0)
        high = min(peak + int(np.floor(shift + reach)), len(scan) - 1)
        moment, growth, spread, lever = 0.0, 0.0, 0.0, 0.0
        for v in range(low, high + 1):
            away = v - peak - shift
            square = (away / reach) ** 2
            part, blind = 1.0 - square, 1.0 - _BLIND * square
            level = scan[v] - base - slope * (v - peak)
            weight = part**3 * blind * away
            moment += weight * level
            turn = part * blind - 6.0 * square * blind - 2.0 * _BLIND * square * part
            growth += part**2 * turn * level
            spread += weight * weight
            lever += weight * away
        if growth <= 0.0:
            return 0.0, 0.0
        shift += min(max(moment / growth, -1.0), 1.0)
        deviation = np.sqrt(spread + tilt * lever**2) / growth
    return shift, deviation
