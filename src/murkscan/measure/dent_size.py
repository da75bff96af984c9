"""How deep, how wide and where a dent is, each with its uncertainty."""

import math
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool
from scipy.ndimage import binary_dilation, label, laplace

from ..geometry.correlated_errors import covariance_of_sums
from ..geometry.height_map import Map, MapFrame
from ..types.arrays import Points, Vector
from ..types.dent import Dent
from ..types.deviation import Deviation
from ..types.quantity import Quantity
from .dent_depth import SearchedScan, measure_depth
from .sample import Sample

_FLOOR = 0.8
"""Share of its greatest depth down to which a dent has its floor."""
_RIM = 3
"""Cells around a dent that are its rim."""
_MOST_OFF = 3.0
"""Ratio of a dent's depth and the averaged map's, beyond which one of them is wrong: averaging
takes a third off the smallest dents."""
_MOST_AT_RIM = 200
"""Points of the rim for which the rig's errors are traced."""


@dataclass(frozen=True, eq=False)
class DentRegion:
    """The cells of a map that a dent covers."""

    frame: MapFrame
    """The map."""
    cells: Bool[np.ndarray, "h w"]
    """Which of its cells."""
    deepest: tuple[int, int]
    """Row and column of the deepest one."""
    level: float
    """Depth down to which the dent reaches [m]."""
    noise: float
    """Standard deviation of the map [m]."""
    sign: float
    """-1 for a dent, 1 for a bump."""
    smoothed: float
    """Standard deviation of the map's smoothing, in cells."""

    @property
    def radius(self) -> float:
        """Radius of the circle of its area [m]."""
        return self.frame.cell * math.sqrt(self.cells.sum() / math.pi)


def measure_dent(region: DentRegion, scan: SearchedScan, values: Map) -> Dent | None:
    """Measure one dent; None where its depth cannot be told from none.

    Its depth is that of a polynomial fitted to the points around its deepest place; its middle is
    the centre of gravity of what is missing; its rim lies where the averaged map is at a tenth of
    its depth.

    Args:
        region: The cells that it covers.
        scan: The scan.
        values: The averaged map [m].
    """
    sample, deviation, located = scan.sample, scan.deviation, scan.located
    inside = region.cells[region.frame.cells_of(located)]
    here, off = sample[inside], deviation[inside]
    reference = float(np.median(off.sigma_reference))
    middle, spread, volume, sigma_volume = _balance(region, here, off, located[inside], values)
    common, moved = _common_part(region, sample, located)
    area = float(region.cells.sum()) * region.frame.cell**2
    depth = measure_depth(scan, _floor_middle(region, values), region.radius, common=common)
    if depth is None or not _is_sound(depth, -float(values[region.deepest])):
        return None
    height = _height_at(located[inside], middle)
    axes = region.frame.map_from_world
    along = np.array([spread[0], spread[1], depth.sigma_independent])
    independent = np.sqrt((axes.T**2) @ along**2)
    return Dent(
        place=region.frame.place(np.array([[*middle, height]]))[0],
        sigma_place=np.hypot(independent, moved),
        depth=depth,
        diameter=_measure_diameter(region, values, reference),
        volume=Quantity(
            "volume",
            volume,
            "m3",
            math.hypot(sigma_volume, reference * area),
            None if common is None else common * area,
        ),
        num_points=int(inside.sum()),
    )


def _is_sound(depth: Quantity, on_map: float) -> bool:
    """Tell whether a depth is none by no chance, and what the averaged map shows there."""
    low, high = depth.interval
    return (low > 0 or high < 0) and 1 / _MOST_OFF < depth.value / on_map < _MOST_OFF


def _floor_middle(region: DentRegion, values: Map) -> np.ndarray:
    """Give the middle of the floor around the deepest cell [m]; noise shifts that on a flat one."""
    depth = region.sign * np.where(region.cells, values, 0.0)
    floors, _ = label(depth > _FLOOR * depth[region.deepest])
    rows, columns = np.nonzero(floors == floors[region.deepest])
    return (np.array([columns.mean(), rows.mean()]) + 0.5) * region.frame.cell


def _balance(
    region: DentRegion, here: Sample, off: Deviation, located: Points, values: Map
) -> tuple[np.ndarray, np.ndarray, float, float]:
    """Give the middle of what is missing, its deviation along the map, and the volume with its."""
    rows, columns = np.nonzero(region.cells)
    depth = -values[rows, columns]
    # Where profiles lie as far apart as cells, a cell's points do not lie about its middle.
    number = region.frame.gather(located, located[:, 2])[1][rows, columns]
    sums = [region.frame.gather(located, along)[0][rows, columns] for along in located.T[:2]]
    centres = (np.stack([columns, rows], axis=1) + 0.5) * region.frame.cell
    means = np.stack(sums, axis=1) / np.maximum(number, 1.0)[:, None]
    places = np.where(number[:, None] > 0, means, centres)
    # Less the level at which it ends, so that where noise lets it end moves nothing.
    missing = region.sign * values[rows, columns] - region.level
    middle = (missing @ places) / missing.sum()
    area = len(depth) * region.frame.cell**2
    facing = max(float(np.median(off.normals @ region.frame.map_from_world[2])), 0.1)
    volume = float(depth.mean()) * area / facing
    # Every point stands for the same share of the area.
    share = 1.0 / len(off)
    weights = np.concatenate(
        [
            (located[:, :2] - middle) * share / missing.mean(),
            np.full((len(off), 1), share * area / facing),
        ],
        axis=1,
    )
    errors = off.values - values[region.frame.cells_of(located)]
    spread = np.sqrt(np.diag(covariance_of_sums(weights, errors, here.profile, here.line)))
    return middle, spread[:2], volume, float(spread[2])


def _measure_diameter(region: DentRegion, values: Map, reference: float) -> Quantity:
    """Compute the diameter of a circle of the dent's area; its rim moves with the map's noise.

    Averaging fills dents and widens rims: what it does to a surface that curves is taken back.

    References:
        Lindeberg, Scale-Space Theory in Computer Vision, 1994, section 1.2 (the diffusion equation:
        a Gaussian adds half its variance times the Laplacian).
    """
    heights = np.nan_to_num(region.sign * values)
    sharp = heights - region.smoothed**2 / 2 * laplace(heights)
    level = region.level * float(sharp[region.deepest] / heights[region.deepest])
    parts, _ = label(sharp > level)
    cells = parts == parts[region.deepest]
    rim = cells & binary_dilation(~cells)
    slopes = np.hypot(*np.gradient(heights, region.frame.cell))
    shift = math.hypot(region.noise, reference) / max(float(slopes[rim].mean()), 1e-9)
    diameter = 2 * region.frame.cell * math.sqrt(cells.sum() / math.pi)
    # Half a cell is what counting cells leaves open.
    sigma = math.hypot(2 * shift, region.frame.cell / math.sqrt(3))
    return Quantity("diameter", diameter, "m", sigma, 0.0)


def _common_part(
    region: DentRegion, sample: Sample, located: Points
) -> tuple[float | None, Vector]:
    """Give how the rig's errors deepen the dent, and how they move it, as deviations [m]."""
    if sample.shifts is None:
        return None, np.zeros(3)
    row, column = region.deepest
    start = (np.array([column, row]) + 0.5) * region.frame.cell
    deepest = np.array([int(np.argmin(np.linalg.norm(located[:, :2] - start, axis=1)))])
    ring = binary_dilation(region.cells, iterations=_RIM) & ~region.cells
    at_rim = np.flatnonzero(ring[region.frame.cells_of(located)])
    moved = sample.shifts(deepest)[0]
    common = np.linalg.norm(moved, axis=1)
    if len(at_rim) == 0:
        return float(np.linalg.norm(region.frame.map_from_world[2] @ moved)), common
    at_rim = at_rim[:: max(len(at_rim) // _MOST_AT_RIM, 1)]
    change = moved - np.nanmean(sample.shifts(at_rim), axis=0)
    return float(np.linalg.norm(region.frame.map_from_world[2] @ change)), common


def _height_at(located: Points, middle: np.ndarray) -> float:
    """Give the usual height of the points nearest to a place of the map [m]."""
    away = np.linalg.norm(located[:, :2] - middle, axis=1)
    return float(np.median(located[np.argsort(away)[:9], 2]))
