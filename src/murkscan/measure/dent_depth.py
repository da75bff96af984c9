"""How deep a dent is: a polynomial through its floor, and how far the same one errs elsewhere."""

import itertools
import math
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int
from scipy.ndimage import distance_transform_edt
from scipy.spatial import KDTree

from ..geometry.correlated_errors import covariance_of_fit
from ..geometry.height_map import Map, MapFrame
from ..types.arrays import Points, Scalars
from ..types.deviation import Deviation
from ..types.quantity import Quantity
from .sample import Sample

_NARROW, _WIDE = 0.4, 0.6
"""Radii around the deepest place, in the dent's radius, over which its floor is a paraboloid, and a
polynomial of fourth order."""
_ELSEWHERE = 8
"""Radii of the polynomial up to which it is fitted to intact places, one radius apart."""
_CLEAR = 1.5
"""Distance of such a place from every dent, in the same radius."""
_TREND = 3.0
"""Radius around such a place over which a paraboloid follows the surface, in the same radius."""
_FEWEST_PLACES = 10
"""Places below which they tell nothing: of three that do not overlap."""
_LEAST_SHARE = 0.7
"""Share of the floor's points below which a place lies at a rim or in a gap."""
_SECTORS = 8
"""Parts of the ring around a floor, each of which must have points: beyond the last point a
polynomial tells nothing."""
_TWICE = 2
"""Points that each coefficient of a polynomial needs."""

Place = Float[np.ndarray, "2"]
Numbers = Int[np.ndarray, " some"]


@dataclass(frozen=True, eq=False)
class SearchedScan:
    """A scan on its map, with what no dent has touched."""

    frame: MapFrame
    """The map."""
    sample: Sample
    """The points of the scan that belong to the surface."""
    deviation: Deviation
    """Their distances from the reference."""
    located: Points
    """Their places on the map [m]."""
    tree: KDTree
    """The same places, without their heights."""
    clearance: Map
    """Distance of each cell of the map from the nearest dent or bump [m]."""

    @classmethod
    def of(
        cls,
        frame: MapFrame,
        sample: Sample,
        deviation: Deviation,
        located: Points,
        is_dented: np.ndarray,
    ) -> "SearchedScan":
        """Put a scan and its dents together; `is_dented` tells which cells any of them covers."""
        clearance = (
            np.asarray(distance_transform_edt(~is_dented)) * frame.cell
            if is_dented.any()
            else np.full(frame.shape, np.inf)
        )
        return cls(frame, sample, deviation, located, KDTree(located[:, :2]), clearance)

    def around(self, place: Place, reach: float) -> Numbers:
        """Give the numbers of the points around a place."""
        return np.array(self.tree.query_ball_point(place, reach), int)


@dataclass(frozen=True, eq=False)
class _Floor:
    """A polynomial through the deviations around a place."""

    place: Place
    reach: float
    order: int
    inside: Numbers
    design: Float[np.ndarray, "n p"]
    coefficients: Float[np.ndarray, " p"]

    def is_surrounded(self, scan: SearchedScan) -> bool:
        """Tell whether points lie all around its middle, and enough of them."""
        off = scan.located[self.inside, :2] - self.place
        ring = off[np.linalg.norm(off, axis=1) > self.reach / 2]
        sectors = np.floor(np.arctan2(ring[:, 1], ring[:, 0]) / (2 * math.pi) * _SECTORS) % _SECTORS
        enough = len(self.inside) >= _TWICE * len(self.coefficients)
        return enough and len(np.unique(sectors)) == _SECTORS

    @classmethod
    def through(
        cls, scan: SearchedScan, place: Place, reach: float, *, order: int, clear: float = 0.0
    ) -> "_Floor":
        """Fit it to the points up to a distance that are clear of dents by another."""
        inside = scan.around(place, reach)
        if clear:
            inside = inside[scan.clearance[scan.frame.cells_of(scan.located[inside])] > clear]
        design = _terms((scan.located[inside, :2] - place) / reach, order)
        # By the normal equations, a hundred times sooner than from thousands of points: no term is
        # larger than one, and their condition, some 46, may well be squared.
        normal, right = design.T @ design, design.T @ scan.deviation.values[inside]
        return cls(place, reach, order, inside, design, np.linalg.lstsq(normal, right)[0])

    def terms_at(self, place: Place) -> Float[np.ndarray, " p"]:
        return _terms((place - self.place)[None] / self.reach, self.order)[0]

    def value_at(self, place: Place) -> float:
        return float(self.terms_at(place) @ self.coefficients)


def measure_depth(
    scan: SearchedScan, start: Place, radius: float, *, common: float | None
) -> Quantity | None:
    """Give the depth of a dent, by a polynomial of fourth order through its floor.

    None where that is not surrounded by points, as at a rim.

    Beside rig and reference three things err. The points: how far, the residuals tell, and what the
    same polynomial gives at intact places, where it should give nothing; an error that the
    polynomial follows shows only there. The polynomial: by no more than it differs from a
    paraboloid over a narrower part, as far as each takes away most of what the one before leaves.
    And what blurs or joins neighbouring points flattens the floor: by as much as a mean over two
    spacings would, for a scan resolves nothing shorter.

    Args:
        scan: The scan.
        start: The deepest place of the averaged map [m].
        radius: Radius of the dent [m].
        common: How the rig's errors deepen it [m]; None where the rig states none.

    References:
        JCGM 100:2008, 4.3.7 (a bound as a standard deviation) and G.4.1 (degrees of freedom).
        Shannon, Communication in the presence of noise, Proc. IRE 37(1), 1949, theorem 1 (what
        samples resolve).
    """
    cell = scan.frame.cell
    narrow = _Floor.through(scan, start, max(_NARROW * radius, 2 * cell), order=2)
    wide = _Floor.through(scan, start, max(_WIDE * radius, 3 * cell), order=4)
    deepest = start + narrow.reach * np.array(_turning_point(narrow.coefficients))
    if not (narrow.is_surrounded(scan) and wide.is_surrounded(scan)):
        return None
    own, degrees = _own_part(scan, wide, deepest)
    bounds = (
        wide.value_at(deepest) - narrow.value_at(deepest),
        _strongest_curvature(narrow) * _square_spacing(scan.sample, wide) / 6,
    )
    reference = float(np.median(scan.deviation.sigma_reference[wide.inside]))
    sigma = math.hypot(own, reference, *(bound / math.sqrt(3) for bound in bounds))
    degrees *= (sigma / max(own, 1e-300)) ** 4
    return Quantity("depth", -wide.value_at(deepest), "m", sigma, common, degrees)


def _strongest_curvature(floor: _Floor) -> float:
    """Give how strongly a paraboloid bends, in the direction in which it bends most [1/m]."""
    _, _, _, xx, xy, yy = floor.coefficients / floor.reach**2
    return float(np.abs(np.linalg.eigvalsh([[2 * xx, xy], [xy, 2 * yy]])).max())


def _square_spacing(sample: Sample, floor: _Floor) -> float:
    """Give the squares of the distances between profiles and between scan lines, added [m²]."""
    counts = [len(np.unique(numbers[floor.inside])) for numbers in (sample.profile, sample.line)]
    return sum((2 * floor.reach / max(count, 1)) ** 2 for count in counts)


def _own_part(scan: SearchedScan, floor: _Floor, deepest: Place) -> tuple[float, float]:
    """Give the deviation of a depth that comes from the points [m], and its degrees of freedom."""
    inside, there = floor.inside, floor.terms_at(deepest)
    errors = scan.deviation.values[inside] - floor.design @ floor.coefficients
    profile, line = scan.sample.profile[inside], scan.sample.line[inside]
    trust = covariance_of_fit(floor.design, errors, profile, line)
    own = math.sqrt(float(there @ trust.matrix @ there))
    elsewhere = _fit_elsewhere(scan, floor)
    if len(elsewhere) < _FEWEST_PLACES:
        return own, trust.degrees
    # One radius apart, π places share what one of them covers.
    degrees = len(elsewhere) / math.pi
    return max((own, trust.degrees), (float(np.sqrt(np.mean(elsewhere**2))), degrees))


def _fit_elsewhere(scan: SearchedScan, floor: _Floor) -> Scalars:
    """Give what the same polynomial gives at intact places [m], beside a paraboloid around them.

    A hull is never quite as it was drawn: long waves are its own, and no error.
    """
    found = []
    least, clear = _LEAST_SHARE * len(floor.inside), (_CLEAR - 1) * floor.reach
    steps = range(-_ELSEWHERE, _ELSEWHERE + 1)
    for step in itertools.product(steps, steps):
        place = floor.place + floor.reach * np.array(step)
        if not _is_intact(scan, place, floor.reach):
            continue
        there = _Floor.through(scan, place, floor.reach, order=floor.order)
        if len(there.inside) >= least:
            trend = _Floor.through(scan, place, _TREND * floor.reach, order=2, clear=clear)
            found.append(there.value_at(place) - trend.value_at(place))
    return np.array(found)


def _is_intact(scan: SearchedScan, place: Place, reach: float) -> bool:
    row, column = np.floor(place[::-1] / scan.frame.cell).astype(int).tolist()
    height, width = scan.frame.shape
    is_on_map = 0 <= row < height and 0 <= column < width
    return is_on_map and bool(scan.clearance[row, column] > _CLEAR * reach)


def _terms(places: Float[np.ndarray, "n 2"], order: int) -> Float[np.ndarray, "n p"]:
    """Give the products of powers of both coordinates: 1, x, y, x², xy and so on."""
    x, y = places.T
    return np.stack([x ** (n - k) * y**k for n in range(order + 1) for k in range(n + 1)], axis=1)


def _turning_point(shape: Float[np.ndarray, "6"]) -> tuple[float, float]:
    """Give where a paraboloid is deepest; its middle where that lies outside."""
    _, x, y, xx, xy, yy = shape.tolist()
    turn = np.array([[2 * xx, xy], [xy, 2 * yy]])
    if abs(np.linalg.det(turn)) < 1e-12 * float(np.abs(turn).max()) ** 2 or not turn.any():
        return 0.0, 0.0
    u, v = np.linalg.solve(turn, [-x, -y]).tolist()
    return (u, v) if math.hypot(u, v) < 1 else (0.0, 0.0)
