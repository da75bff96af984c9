"""An octree whose every node holds an even choice of the points below it, for clouds of any size.

A point need not know its neighbours: from how many points each cell holds follows with which chance
one that has come down to a node stays there, so that every node keeps about the same number::

    level 0   ┌───────────────┐   50 000 of all points, by chance
    level 1   ├───────┬───────┤   50 000 of the rest, in each cell
    level 2   ├───┬───┼───┬───┤   … until what is left of a cell fits into one node
"""

from dataclasses import dataclass
from itertools import accumulate

import numpy as np
from jaxtyping import Float, Int

from ..types.arrays import Indices, Scalars

Cells = Int[np.ndarray, "n 3"]
OfLevel = Int[np.ndarray, "_"]
ChancesOfLevel = Float[np.ndarray, "_"]
OfNodes = Float[np.ndarray, "nodes"]

_MERGED = 4_000_000
"""Keys that are kept before they are counted together."""
DEEPEST = 20
"""Levels that 64 bits have room for."""


def interleave(cells: Cells) -> Indices:
    """Compute Morton keys of cells, whose numbers are below two to the power of `DEEPEST`.

    References:
        Morton, A computer oriented geodetic data base, IBM, 1966.
    """
    keys = np.zeros(len(cells), np.int64)
    for axis in range(3):
        keys |= _spread(cells[:, axis].astype(np.int64)) << axis
    return keys


def part_key(keys: Indices) -> Cells:
    """Give the cells of Morton keys."""
    return np.stack([_gather(keys >> axis) for axis in range(3)], axis=1)


class CellCounter:
    """Counts points by cell, block by block."""

    def __init__(self) -> None:
        self._keys: list[Indices] = []
        self._counts: list[Indices] = []

    def add(self, keys: Indices) -> None:
        """Count the cells of more points, by their Morton keys."""
        cells, counts = np.unique(keys, return_counts=True)
        self._keys.append(cells)
        self._counts.append(counts)
        if sum(map(len, self._keys)) > _MERGED:
            self._merge()

    def counted(self) -> tuple[Indices, Indices]:
        """Give the cells that hold points, in order, and how many each holds."""
        self._merge()
        return self._keys[0], self._counts[0]

    def _merge(self) -> None:
        keys, counts = np.concatenate(self._keys), np.concatenate(self._counts)
        cells, owner = np.unique(keys, return_inverse=True)
        self._keys = [cells]
        self._counts = [np.bincount(owner, counts, len(cells)).astype(np.int64)]


@dataclass(frozen=True, eq=False)
class Octree:
    """The nodes of an octree, level by level, each level in order of Morton keys."""

    depth: int
    """Level at which cells were counted, the deepest there is."""
    keys: tuple[OfLevel, ...]
    """Of the nodes of each level."""
    chances: tuple[ChancesOfLevel, ...]
    """With which a point that has come down to a node stays there."""
    expected: OfNodes
    """Points of each node, about."""

    @classmethod
    def plan(cls, keys: Indices, counts: Indices, depth: int, *, usual: int) -> "Octree":
        """Decide on the nodes.

        Args:
            keys: Cells of the deepest level that hold points, in order.
            counts: How many each holds.
            depth: Number of that level.
            usual: Points that a node keeps. One keeps all that come down to it if these are no
                more than twice as many, or if it is of the deepest level.
        """
        left = counts.astype(float)
        nodes, chances, expected = list[Indices](), list[Scalars](), list[Scalars]()
        for level in range(depth + 1):
            cells, owner = np.unique(keys >> (3 * (depth - level)), return_inverse=True)
            held = np.bincount(owner, left, len(cells))
            is_last = (held <= 2 * usual) | (level == depth)
            chance = np.where(is_last, 1.0, usual / np.maximum(held, 1.0))
            nodes.append(cells)
            chances.append(chance)
            expected.append(held * chance)
            left = left * (1 - chance[owner])
            goes_on = left > 0
            keys, left = keys[goes_on], left[goes_on]
            if not len(keys):
                break
        return cls(depth, tuple(nodes), tuple(chances), np.concatenate(expected))

    @property
    def starts(self) -> list[int]:
        """Number of the first node of each level."""
        return [0, *accumulate(len(keys) for keys in self.keys)][:-1]

    def assign(self, keys: Indices, random: np.random.Generator) -> Indices:
        """Give the number of the node in which each point stays.

        Args:
            keys: Cells of points at the deepest level.
            random: Decides.
        """
        node = np.full(len(keys), -1)
        down = np.arange(len(keys))
        levels = zip(self.keys, self.chances, self.starts, strict=True)
        for level, (cells, chances, start) in enumerate(levels):
            which = np.searchsorted(cells, keys[down] >> (3 * (self.depth - level)))
            stays = random.random(len(down)) < chances[which]
            node[down[stays]] = start + which[stays]
            down = down[~stays]
        return node

    def levels(self) -> Indices:
        """Give the level of every node."""
        return np.repeat(np.arange(len(self.keys)), [len(keys) for keys in self.keys])


def _spread(numbers: Indices) -> Indices:
    """Put two zeros between the bits of numbers of 21 bits."""
    x = numbers & 0x1FFFFF
    for shift, mask in _STEPS:
        x = (x | (x << shift)) & mask
    return x


def _gather(keys: Indices) -> Indices:
    """Take every third bit: undoes `_spread`."""
    x = keys & _STEPS[-1][1]
    for (shift, _), mask in zip(_STEPS[::-1], _GATHERED, strict=True):
        x = (x | (x >> shift)) & mask
    return x


_STEPS = (
    (32, 0x1F00000000FFFF),
    (16, 0x1F0000FF0000FF),
    (8, 0x100F00F00F00F00F),
    (4, 0x10C30C30C30C30C3),
    (2, 0x1249249249249249),
)
"""How far bits are moved, and which are kept: 21 bits become 63."""
_GATHERED = (*(mask for _, mask in _STEPS[-2::-1]), 0x1FFFFF)
