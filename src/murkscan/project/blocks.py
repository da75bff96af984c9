"""A scan's parts in blocks that fit into memory, each with what lies beside it."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from ..types.cloud import PointCloud
from ..types.profile import Profile

T = TypeVar("T", Profile, PointCloud)

BLOCK = 60_000
"""Points of a block, about: with those beside it some 100 MB while outliers are looked for, and as
many blocks are looked at together as there are workers."""
_HALO = 20_000
"""Points on either side of it that are looked at, too: 28 profiles of 720 points."""
_PROFILES = 24
"""Profiles on either side, at least: a surface is evened out over eight."""


@dataclass(frozen=True)
class Block:
    """Parts that are worked on together, and those before and behind, which help to judge them."""

    before: tuple[int, ...]
    parts: tuple[int, ...]
    after: tuple[int, ...]


def cut_blocks(sizes: Mapping[int, int], *, block: int = BLOCK) -> list[Block]:
    """Join the parts of a scan to blocks.

    What comes of a scan depends on where they are cut, so that is always the same, whoever does
    the work; a scan that fits into one block is one block.

    Args:
        sizes: Points of each part, by its number.
        block: Points of a block, about.
    """
    numbers, joined, count = sorted(sizes), list[list[int]](), block
    for number in numbers:
        if count >= block:
            joined.append([])
            count = 0
        joined[-1].append(number)
        count += sizes[number]
    return [
        Block(
            before=_beside(reversed([n for n in numbers if n < parts[0]]), sizes)[::-1],
            parts=tuple(parts),
            after=_beside((n for n in numbers if n > parts[-1]), sizes),
        )
        for parts in joined
    ]


def _beside(numbers: Iterable[int], sizes: Mapping[int, int]) -> tuple[int, ...]:
    """Take parts until they have points enough."""
    taken, count = list[int](), 0
    for number in numbers:
        if count >= _HALO:
            break
        taken.append(number)
        count += sizes[number]
    return tuple(taken)


def trim_beside(before: T, after: T) -> tuple[T, T]:
    """Keep of what was taken on either side what is looked at."""
    if len(before) > _HALO:
        least = np.unique(before.frame)[-_PROFILES:][0]
        before = before[before.frame > min(int(before.frame[-_HALO]), int(least) - 1)]
    if len(after) > _HALO:
        most = np.unique(after.frame)[:_PROFILES][-1]
        after = after[after.frame < max(int(after.frame[_HALO]), int(most) + 1)]
    return before, after
