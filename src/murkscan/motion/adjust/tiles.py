"""Tiles of one leg's relief, looked for in another leg's: rough ties over centimetres.

Fine pairs need the legs to lie within a bump's width of one another. Before that, tiles of the
relief (what a leg's own smooth surface leaves) are correlated with the other leg's.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial import cKDTree

from ..._kernels.tiles import correlate, draw_relief
from ...types.arrays import Indices, Points, Scalars, Vector
from .doubt import Doubt
from .legs import Facets
from .peaks import find_peak
from .relief import FLATTEST, Relief
from .ties import OPEN, Ties

_FILLED = 0.4
"""Share of a tile that must lie on the other leg."""
_FEWEST = 40
"""Facets below which a tile is none."""
_STRETCHES = (1.0, 0.8, 1.25, 0.65, 1.55)
"""Lengths along the way that a tile may have, in the one it seems to have, in the order in which
they are tried: a speed that is not known is off by so much."""
_FAR = 6.0
"""Pixels beyond which tiles are looked for in pixels of twice the size."""
_VAGUE = 1.5
"""Standard deviation, in pixels, from which a relief does not tell its place along an axis: bumps
that wide lie on one another anyhow, and the length of a seam shows no end."""
_SIGMA_OFF = 0.5e-3
"""Standard deviation of a found distance along the normal [m]."""


@dataclass(frozen=True, eq=False)
class _Found:
    """Where a tile lies in the other leg."""

    which: Indices
    """Facets of the tile."""
    frame: Float[np.ndarray, "3 3"]
    """Rows: along the way, across it, the normal."""
    shift: Vector
    """From where the tile lies to where it belongs, along these [m]."""
    spread: Float[np.ndarray, "2 2"]
    """Covariance of the shift along the first two [m²]."""
    vague: float
    """Variance from which it does not tell where the tile belongs [m²]."""
    time: float

    @property
    def told(self) -> Vector:
        """Give the shift, with NaN along axes along which the relief does not tell it."""
        is_told = np.append(np.diag(self.spread) < self.vague, True)
        return np.where(is_told, self.shift, np.nan)

    def as_axes(self) -> tuple[Float[np.ndarray, "3 3"], Vector]:
        """Give three directions in the world along which it errs by itself, and its variances.

        A seam ties one direction, a corner all.
        """
        variance, axes = np.linalg.eigh(self.spread)
        variance = np.where(variance < self.vague, variance, OPEN)
        directions = np.vstack([axes.T @ self.frame[:2], self.frame[2:]])
        return directions, np.append(variance, _SIGMA_OFF**2)


def tie_tiles(
    a: Relief,
    b: Relief,
    tile: tuple[float, float],
    doubt: Doubt,
    forward: Float[np.ndarray, "r 3"],
) -> tuple[Ties, Scalars]:
    """Look for the tiles of one leg in another.

    Args:
        a: Whose tiles are looked for.
        b: In which.
        tile: Size along and across the way [m].
        doubt: How far from where it lies now a tile may be.
        forward: Direction of the way at each row of `a`.

    Returns:
        The ties of those that were found, and the times [s] of all that have relief to be found by,
        and lie on the other leg.
    """
    found, looked_for = [], []
    for which in _cut(a.facets, tile):
        pair = _lay_side_by_side(a, b, which, tile, doubt, forward)
        if pair is None:
            continue
        looked_for.append(pair.time)
        place = next(filter(None, (_find(b, pair, stretch) for stretch in _STRETCHES)), None)
        if place is not None:
            found.append(place)
    ties = _as_ties(a.facets, b, _consistent(found, a.facets.leg.size))
    return ties, np.array(looked_for)


def _cut(facets: Facets, tile: tuple[float, float]) -> list[Indices]:
    """Give the facets of each tile."""
    leg = facets.leg
    rows, columns = (max(round(t / leg.size), 2) for t in tile)
    # Tiles of the same width over all of the line, none of them narrow.
    num = max(leg.num_columns // columns, 1)
    piece = np.minimum(facets.column * num // leg.num_columns, num - 1)
    key = facets.row // rows * num + piece
    order = np.argsort(key, kind="stable")
    parts = np.split(order, np.flatnonzero(np.diff(key[order])) + 1)
    return [part for part in parts if len(part) >= _FEWEST]


@dataclass(frozen=True, eq=False)
class _Pair:
    """A tile and what of the other leg lies about it, both in the tile's frame."""

    which: Indices
    """Facets of the tile."""
    time: float
    frame: Float[np.ndarray, "3 3"]
    own: Points
    """Facets of the tile [m]."""
    other: Float[np.ndarray, "k 3"]
    """Facets of the other leg [m]."""
    heights: Scalars
    others_heights: Float[np.ndarray, " k"]
    reach: Float[np.ndarray, "2"]
    pitch: float


def _lay_side_by_side(
    a: Relief,
    b: Relief,
    which: Indices,
    tile: tuple[float, float],
    doubt: Doubt,
    forward: Float[np.ndarray, "r 3"],
) -> _Pair | None:
    """Gather what a tile is to be compared with; None where it is flat, or off the other leg."""
    facets, pitch = a.facets, max(a.facets.leg.size, b.facets.leg.size)
    centre = facets.points[which].mean(axis=0)
    frame = _frame(facets.normals[which].mean(axis=0), forward[facets.row[which[0]]])
    half = float(np.hypot(*tile)) / 2
    nearest = b.tree.query(centre, distance_upper_bound=half + doubt.most)[1]
    if nearest == b.tree.n or a.is_flat(which):
        return None
    reach = doubt.reach(
        centre,
        facets.leg.row_times[facets.row[which[0]]],
        b.facets.leg.row_times[b.facets.row[nearest]],
        frame[:2],
        4 * pitch,
    )
    there = np.asarray(b.tree.query_ball_point(centre, half + float(np.hypot(*reach))), np.int64)
    # Another side of a thin plate is not what is looked for.
    there = there[b.facets.normals[there] @ frame[2] > 0]
    if len(there) < _FEWEST:
        return None
    return _Pair(
        which,
        float(facets.leg.row_times[facets.row[which]].mean()),
        frame,
        (facets.points[which] - centre) @ frame.T,
        (b.facets.points[there] - centre) @ frame.T,
        a.heights[which],
        b.heights[there],
        reach,
        2 * pitch if reach.max() > _FAR * pitch else pitch,
    )


def _find(b: Relief, pair: _Pair, stretch: float) -> _Found | None:
    """Find a tile, stretched along the way by what its speed may be off."""
    own, pitch = pair.own * [stretch, 1.0, 1.0], pair.pitch
    corner, size = own[:, :2].min(axis=0), np.ptp(own[:, :2], axis=0)
    shape = np.ceil(size / pitch).astype(int) + 2
    margin = np.ceil(pair.reach / pitch).astype(int)
    small = draw_relief(own[:, 0] - corner[0], own[:, 1] - corner[1], pair.heights, pitch, *shape)
    start = corner - margin * pitch
    large = draw_relief(
        pair.other[:, 0] - start[0],
        pair.other[:, 1] - start[1],
        pair.others_heights,
        pitch,
        *(shape + 2 * margin),
    )
    filled = np.isfinite(small)
    if filled.sum() < _FEWEST / 2 or np.nanstd(small) < FLATTEST:
        return None
    peak = find_peak(correlate(small, large, int(_FILLED * filled.sum())), int(filled.sum()))
    if peak is None:
        return None
    moved = (peak.place - margin) * pitch
    off = _offset_along_normal(own, pair.other, moved, pitch)
    if off is None:
        return None
    vague = (_VAGUE * pitch) ** 2
    spread = pitch**2 * peak.spread
    return _Found(pair.which, pair.frame, np.append(moved, off), spread, vague, pair.time)


def _frame(normal: Vector, forward: Vector) -> Float[np.ndarray, "3 3"]:
    normal = normal / np.linalg.norm(normal)
    along = forward - (forward @ normal) * normal
    along /= max(float(np.linalg.norm(along)), 1e-12)
    return np.stack([along, np.cross(normal, along), normal])


def _offset_along_normal(
    own: Points, other: Float[np.ndarray, "k 3"], moved: Float[np.ndarray, "2"], pitch: float
) -> float | None:
    """Give how far a moved tile lies below the other leg [m]."""
    found = cKDTree(other[:, :2]).query(own[:, :2] + moved, distance_upper_bound=pitch)
    near = np.isfinite(found[0])
    if near.sum() < _FEWEST / 2:
        return None
    return float(np.median(other[np.asarray(found[1])[near], 2] - own[near, 2]))


def _consistent(found: list[_Found], pitch: float) -> list[_Found]:
    """Keep the tiles whose shift is about that of those before and after."""
    if len(found) < 3:
        return []
    times = np.array([one.time for one in found])
    shifts = np.array([one.told for one in found])
    kept = []
    for i, one in enumerate(found):
        near = np.argsort(np.abs(times - times[i]), kind="stable")[1:8]
        middle = [
            np.median(s[np.isfinite(s)]) if np.isfinite(s).any() else 0 for s in shifts[near].T
        ]
        # Along an axis that a tile does not tell it agrees with all.
        off = np.nan_to_num(np.abs(shifts - np.array(middle))).max(axis=1)
        if off[i] <= max(3 * pitch, 3 * 1.5 * float(np.median(off[near]))):
            kept.append(one)
    return kept


def _as_ties(facets: Facets, b: Relief, found: list[_Found]) -> Ties:
    """Tie each tile's middle to where it belongs: along two axes of the surface, and the normal."""
    count = 3 * len(found)
    leg, other = facets.leg, b.facets.leg
    time_a, time_b = np.empty(count), np.empty(count)
    points, matched, directions = (np.empty((count, 3)) for _ in range(3))
    variance = np.empty(count)
    for k, one in enumerate(found):
        centre = facets.points[one.which].mean(axis=0)
        there = centre + one.shift @ one.frame
        nearest = int(b.tree.query(there)[1])
        into = slice(3 * k, 3 * k + 3)
        time_a[into], points[into], matched[into] = one.time, centre, there
        time_b[into] = other.row_times[b.facets.row[nearest]]
        directions[into], variance[into] = one.as_axes()
    return Ties(
        np.full(count, leg.number), time_a, points,
        np.full(count, other.number), time_b, matched,
        directions, np.zeros(count), variance,
    )  # fmt: skip
