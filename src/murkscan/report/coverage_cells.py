"""Sums over the cells of a map whose size is not known beforehand."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from ..geometry.row_keys import row_keys
from ..types.arrays import Indices, Scalars
from .strips import Strips
from .swath import CAUSES

_FAR = 2**31
"""Beyond the number of any cell."""
_STRAYS = 0.001
"""Share of the area on either side of the map that may lie outside, with points that are false."""
_MOST = 1200
"""Cells of a side, at most."""
LONGEST = 8192
"""The same of a map that grows; it is coarsened before it is longer."""
_CLASSES = 1 + len(CAUSES)
_NAMES = ("covered", *CAUSES)


@dataclass(frozen=True, eq=False)
class CellSums:
    """What some frames add to the cells of a map; one cell a row."""

    cell: Int[np.ndarray, "n 2"]
    """Number of the cell along the motion and across."""
    points: Scalars
    """Points in it."""
    areas: Float[np.ndarray, "n k"]
    """Area in it that is covered, then that missing by each cause [m²]."""

    @classmethod
    def from_part(cls, along: Scalars, across: Scalars, strips: Strips, edge: float) -> "CellSums":
        """Sum over the points [m] and strips of some frames, in cells of an edge [m]."""
        pieces, cell_of_piece = _cut_at_cells(strips, edge)
        cell_of_point = _as_key(_number(along, edge), _number(across, edge))
        keys, which = np.unique(np.concatenate([cell_of_point, cell_of_piece]), return_inverse=True)
        num = len(cell_of_point)
        points = np.bincount(which[:num], minlength=len(keys)).astype(float)
        flat = which[num:] * _CLASSES + strips.cause[pieces]
        counts = np.bincount(pieces, minlength=len(strips.length))
        area = (strips.length * strips.width / np.maximum(counts, 1))[pieces]
        areas = np.bincount(flat, weights=area, minlength=len(keys) * _CLASSES)
        return cls(_as_cells(keys), points, areas.reshape(-1, _CLASSES))

    def as_columns(self) -> dict[str, np.ndarray]:
        """Give them as columns of a table."""
        areas = {f"{name}_m2": layer for name, layer in zip(_NAMES, self.areas.T, strict=True)}
        return {"along": self.cell[:, 0], "across": self.cell[:, 1], "points": self.points, **areas}

    @classmethod
    def from_columns(cls, columns: Mapping[str, np.ndarray]) -> "CellSums":
        """Make them of what `as_columns` gave."""
        cells = np.stack([columns["along"], columns["across"]], axis=1)
        areas = np.stack([columns[f"{name}_m2"] for name in _NAMES], axis=1)
        return cls(cells, columns["points"], areas)

    def coarser(self) -> "CellSums":
        """Count by cells of twice the edge; a cell may have several rows."""
        return CellSums(self.cell // 2, self.points, self.areas)


def choose_fullest(sheets: Sequence[Sequence[CellSums]]) -> Sequence[CellSums]:
    """Take each cell as the sheet has it that covers most of it, so that no surface counts twice.

    Args:
        sheets: The sums of each sheet, in parts.

    Returns:
        Sums of cells; the points of a cell are those of all sheets.
    """
    if len(sheets) == 1:
        return sheets[0]
    whole = [add_up(parts) for parts in sheets]
    cells = np.concatenate([one.cell for one in whole])
    areas = np.concatenate([one.areas for one in whole])
    _, first, which = np.unique(row_keys(cells), return_index=True, return_inverse=True)
    # The last of a cell's entries, in order of what they cover, then of what they know.
    order = np.lexsort((areas.sum(axis=1), areas[:, 0], which))
    last = order[np.flatnonzero(np.diff(which[order], append=-1))]
    points = np.bincount(which, np.concatenate([one.points for one in whole]), len(first))
    return [CellSums(cells[first], points, areas[last])]


def add_up(parts: Sequence[CellSums]) -> CellSums:
    """Add up what parts of one sheet say of the same cells."""
    cells = np.concatenate([np.zeros((0, 2), np.int64), *(part.cell for part in parts)])
    areas = np.concatenate([np.zeros((0, _CLASSES)), *(part.areas for part in parts)])
    points = np.concatenate([np.zeros(0), *(part.points for part in parts)])
    keys, which = np.unique(_as_key(cells[:, 0], cells[:, 1]), return_inverse=True)
    sums = [np.bincount(which, column, len(keys)) for column in (points, *areas.T)]
    return CellSums(_as_cells(keys), sums[0], np.stack(sums[1:], axis=1).reshape(-1, _CLASSES))


_Map = tuple[tuple[float, float], Int[np.ndarray, "h w"], Float[np.ndarray, "k h w"], Scalars]


def is_too_large(sums: CellSums, most: int) -> bool:
    """Tell whether a map, merged, has more cells than that, or is longer than it may become."""
    if not sums.areas.sum() > 0:
        return False
    low, high = _window(sums.cell, sums.areas.sum(axis=1), longest=2 * LONGEST)
    return len(sums.cell) > most or bool((high - low >= LONGEST).any())


def gather_cells(sums: Sequence[CellSums], *, edge: float, longest: int = _MOST) -> _Map | None:
    """Add up the cells of all parts: corner, points, areas, total; None where nothing has area.

    Cells far out, where a few false points lie, are left out of the map but not of the total.
    """
    cells = np.concatenate([np.zeros((0, 2), np.int64), *(part.cell for part in sums)])
    areas = np.concatenate([np.zeros((0, _CLASSES)), *(part.areas for part in sums)])
    if not areas.sum() > 0:
        return None
    points = np.concatenate([part.points for part in sums])
    low, high = _window(cells, areas.sum(axis=1), longest=longest)
    is_in = ((cells >= low) & (cells <= high)).all(axis=1)
    width, height = (high - low + 1).tolist()
    place = (cells[is_in, 1] - low[1]) * width + cells[is_in, 0] - low[0]
    counted = np.bincount(place, weights=points[is_in], minlength=width * height)
    layers = [np.bincount(place, weights=a, minlength=width * height) for a in areas[is_in].T]
    return (
        (float(low[0] * edge), float(low[1] * edge)),
        counted.astype(np.int64).reshape(height, width),
        np.stack(layers).reshape(-1, height, width),
        areas.sum(axis=0),
    )


def _window(
    cells: Int[np.ndarray, "n 2"], weight: Scalars, *, longest: int
) -> tuple[np.ndarray, np.ndarray]:
    """Give the first and the last cell of a map that holds all but the strays."""
    ends = []
    for numbers in cells.T:
        order = np.argsort(numbers)
        share = np.cumsum(weight[order]) / weight.sum()
        first, last = np.searchsorted(share, [_STRAYS, 1 - _STRAYS])
        low, high = numbers[order][first], numbers[order][min(last, len(order) - 1)]
        margin = 2 + (high - low) // 20
        low, high = max(low - margin, numbers.min()), min(high + margin, numbers.max())
        ends.append((low, min(high, low + longest)))
    return np.array(ends).T[0], np.array(ends).T[1]


def _cut_at_cells(strips: Strips, edge: float) -> tuple[Indices, Indices]:
    """Cut strips both ways into pieces of half a cell at most: the strip of each, and its cell."""
    long, wide = (
        np.maximum(np.ceil(2 * side / edge), 1).astype(np.int64)
        for side in (np.hypot(strips.length, strips.lean), strips.width)
    )
    counts = long * wide
    strip = np.repeat(np.arange(len(counts)), counts)
    number = np.arange(len(strip)) - np.repeat(np.cumsum(counts) - counts, counts)
    on, beside = (
        (number // wide[strip] + 0.5) / long[strip],
        (number % wide[strip] + 0.5) / wide[strip],
    )
    along = strips.start[strip] + on * strips.length[strip]
    aside = (on - 0.5) * strips.lean[strip] + (beside - 0.5) * strips.width[strip]
    return strip, _as_key(_number(along, edge), _number(strips.across[strip] + aside, edge))


def _number(place: Scalars, edge: float) -> Indices:
    return np.floor(place / edge).astype(np.int64)


def _as_key(along: Indices, across: Indices) -> Indices:
    return (along + _FAR // 2) * _FAR + across + _FAR // 2


def _as_cells(keys: Indices) -> Int[np.ndarray, "n 2"]:
    return np.stack([keys // _FAR - _FAR // 2, keys % _FAR - _FAR // 2], axis=1)
