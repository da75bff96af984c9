"""Find where a surface departs from a reference by more than chance."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import label
from scipy.special import ndtri

from ..errors import NotEnoughData
from ..geometry.height_map import Map, MapFrame, smooth_map
from ..types.arrays import Mask, Points, Scalars
from ..types.dent import Dent
from ..types.deviation import Deviation
from .dent_depth import SearchedScan
from .dent_size import DentRegion, measure_dent
from .lengths import require_dent_sizes
from .sample import Sample

_CELLS = 8
"""Cells of the map along the smallest dent looked for."""
_SMOOTHING = 0.2
"""Standard deviation of the map's smoothing, in that dent's width."""
_GAUSSIAN = 1.4826
_STRAY = 6.0
"""Robust standard deviations from the map beyond which a point is none of the surface."""
_FALSE_ALARM = 0.05
"""Chance that a map without dents shows one, if its noise were Gaussian …"""
_HEAVY_TAILS = 1.5
"""… which it is not: factor on that threshold."""
_SCATTERS = 3.0
"""Standard deviations of single points below which nothing is told: paint and the finder's habits
move many points together by as much."""
_REFERENCE = 5.0
"""Standard deviations of the reference that a departure must exceed as well: at the rim of a scan a
smooth surface through it is hardly held."""
_LEAST_SUPPORT = 0.3
"""Share of the usual number of points behind a place of the map below which it tells nothing."""
_LEAST_PROFILES = 3
"""Profiles that must show a dent: a particle is gone in the next picture."""
_SHARE_OF_DEPTH = 0.1
"""Share of its depth down to which a dent reaches."""


@dataclass(frozen=True, eq=False)
class DentSearch:
    """What was found, and what could have been."""

    dents: tuple[Dent, ...]
    """Dents and bumps, the deepest first."""
    threshold: float
    """Mean depth, over the map's smoothing, from which a place counts as a dent [m]."""
    noise: float
    """Standard deviation of the map [m]."""
    num_unsure: int = 0
    """Places beyond the threshold whose depth is not told: at a rim, or by no more than chance."""
    remarks: tuple[str, ...] = ()
    """Why the search means less than it says, and what to do; sentences for the user."""


def find_dents(
    sample: Sample, deviation: Deviation, *, smallest: float, least_depth: float = 0.0
) -> DentSearch:
    """Find connected places where a scan lies behind or before its reference.

    Deviations are averaged over a fifth of the smallest dent's width; how much these averages
    scatter over the whole map, with all that errs together, sets the threshold.

    Args:
        sample: The scan's points.
        deviation: How far each lies from the reference.
        smallest: Width of the smallest dent looked for [m].
        least_depth: Depth below which none is told [m].

    Raises:
        InputError: A size is none, or so small that the map is too large.
        NotEnoughData: The scan is smaller than the smallest dent.
    """
    require_dent_sizes(smallest=smallest, least_depth=least_depth)
    known = np.isfinite(deviation.values)
    sample, deviation = sample[known], deviation[known]
    frame = MapFrame.over(sample.cloud.points, deviation.normals, smallest / _CELLS)
    located = frame.locate(sample.cloud.points)
    values, kept = _average(frame, located, deviation.values)
    noise = _GAUSSIAN * float(np.nanmedian(np.abs(values - np.nanmedian(values))))
    patches = max(np.isfinite(values).sum() / (4 * math.pi * (_SMOOTHING * _CELLS) ** 2), 1.0)
    chance = -float(ndtri(_FALSE_ALARM / (2 * patches)))
    single = values[frame.cells_of(located[kept])] - deviation.values[kept]
    scatter = _GAUSSIAN * float(np.nanmedian(np.abs(single)))
    threshold = max(_HEAVY_TAILS * chance * noise, _SCATTERS * scatter, least_depth)
    sample, deviation, located = sample[kept], deviation[kept], located[kept]
    regions = [
        region
        for sign in (-1.0, 1.0)
        for region in _regions(frame, sign * values, threshold, noise, sign)
        if _is_seen_again(region, sample, deviation, located)
        and _is_beyond_reference(region, deviation, located, values, threshold)
    ]
    none = np.zeros(frame.shape, bool)
    is_dented = np.any([none, *(region.cells for region in regions)], axis=0)
    scan = SearchedScan.of(frame, sample, deviation, located, is_dented)
    measured = (measure_dent(region, scan, values) for region in regions)
    dents = [dent for dent in measured if dent is not None]
    dents.sort(key=lambda dent: -abs(dent.depth.value))
    return DentSearch(tuple(dents), threshold, noise, len(regions) - len(dents))


def _average(frame: MapFrame, located: Points, values: Scalars) -> tuple[Map, Mask]:
    """Give the smoothed map, and which points belong to it."""
    kept = np.ones(len(values), bool)
    sigma = _SMOOTHING * _CELLS
    for _ in range(2):
        mean, support = smooth_map(*frame.gather(located[kept], values[kept]), sigma=sigma)
        around = mean[frame.cells_of(located)]
        off = np.abs(values - around)
        # A dent's floor lies below the average over its slopes: that is no reason to leave it out.
        kept = off <= _STRAY * _GAUSSIAN * np.nanmedian(off) + np.abs(around) / 2
    usual = float(np.median(support[np.isfinite(mean)]))
    mean[support < _LEAST_SUPPORT * usual] = np.nan
    if np.isfinite(mean).sum() < _CELLS**2:
        raise NotEnoughData(
            f"The scan covers less than one dent of {_CELLS * frame.cell * 1e3:g} mm; look for "
            "smaller ones with --smallest-mm."
        )
    return mean, kept


def _is_beyond_reference(
    region: DentRegion, deviation: Deviation, located: Points, values: Map, threshold: float
) -> bool:
    """Tell whether a departure is more than map and reference together leave open there."""
    there = region.cells[region.frame.cells_of(located)]
    sigma = float(np.max(deviation.sigma_reference[there], initial=0.0))
    return abs(float(values[region.deepest])) > math.hypot(threshold, _REFERENCE * sigma)


def _is_seen_again(
    region: DentRegion, sample: Sample, deviation: Deviation, located: Points
) -> bool:
    """Tell whether several profiles show a departure of half its greatest depth."""
    inside = region.cells[region.frame.cells_of(located)]
    away = region.sign * deviation.values
    deep = inside & (away > np.quantile(away[inside], 0.98) / 2) if inside.any() else inside
    return len(np.unique(sample.profile[deep])) >= _LEAST_PROFILES


def _regions(
    frame: MapFrame, heights: Map, threshold: float, noise: float, sign: float
) -> list[DentRegion]:
    """Find the connected places above the threshold, and how far each reaches."""
    peaks, count = label(np.nan_to_num(heights, nan=-np.inf) > threshold)
    found: list[DentRegion] = []
    taken = np.zeros(heights.shape, bool)
    order = sorted(range(1, count + 1), key=lambda i: -float(heights[peaks == i].max()))
    for number in order:
        inside = np.where(peaks == number, heights, -np.inf)
        row, column = np.unravel_index(int(np.argmax(inside)), heights.shape)
        if taken[row, column]:
            continue
        level = max(_SHARE_OF_DEPTH * float(heights[row, column]), 2 * noise)
        parts, _ = label(np.nan_to_num(heights, nan=-np.inf) > level)
        cells = parts == parts[row, column]
        taken |= cells
        if 2 * math.sqrt(cells.sum() / math.pi) >= _CELLS / 2:
            deepest, smoothed = (int(row), int(column)), _SMOOTHING * _CELLS
            found.append(DentRegion(frame, cells, deepest, level, noise, sign, smoothed))
    return found
