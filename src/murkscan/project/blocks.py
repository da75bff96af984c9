"""A scan's parts in blocks that fit into memory, each with what lies beside it."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

BLOCK = 150_000
"""Points of a block, about: with those beside it some 200 MB while outliers are looked for, and as
many blocks are looked at together as there are workers."""
HALO = 40_000
"""Points on either side of it that are looked at, too: fifty profiles of 720 points."""


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
        if count >= HALO:
            break
        taken.append(number)
        count += sizes[number]
    return tuple(taken)
