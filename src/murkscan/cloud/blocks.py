"""A scan's profiles in blocks that fit into memory, each with what lies beside it."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from ..types.arrays import Mask
from ..types.profile import Profile

BLOCK = 2_000_000
"""Points of a block, about: some two gigabytes while normals and outliers are looked for."""
_HALO = 200_000
"""Points on either side of it that are looked at, too."""


@dataclass(frozen=True, eq=False)
class ProfileBlock:
    """Some profiles, and those before and behind, which only help to judge them."""

    profile: Profile
    """All points, in order of frames."""
    is_body: Mask
    """Which of them belong to the block."""
    sizes: tuple[int, ...]
    """How many points each part has that the block is made of."""


def cut_blocks(parts: Iterable[Profile], *, block: int = BLOCK) -> Iterator[ProfileBlock]:
    """Join the parts of a scan to blocks; whole frames only.

    A scan that fits into one block is one block: then what comes of it does not depend on where
    the blocks are cut.

    Args:
        parts: Profiles in order of frames; no frame lies in two of them.
        block: Points of a block, about.
    """
    before, body, sizes = Profile.concatenate([]), Profile.concatenate([]), tuple[int, ...]()
    for following, its_sizes in _join(parts, block):
        if sizes:
            yield _with_halo(before, body, following, sizes)
        before, body, sizes = body, following, its_sizes
    if sizes:
        yield _with_halo(before, body, Profile.concatenate([]), sizes)


def _join(parts: Iterable[Profile], block: int) -> Iterator[tuple[Profile, tuple[int, ...]]]:
    waiting: list[Profile] = []
    for part in parts:
        waiting.append(part)
        if sum(map(len, waiting)) >= block:
            yield Profile.concatenate(waiting), tuple(map(len, waiting))
            waiting = []
    yield Profile.concatenate(waiting), tuple(map(len, waiting))


def _with_halo(
    before: Profile, body: Profile, after: Profile, sizes: tuple[int, ...]
) -> ProfileBlock:
    if len(before) > _HALO:
        before = before[before.frame > before.frame[-_HALO]]
    if len(after) > _HALO:
        after = after[after.frame < after.frame[_HALO]]
    is_body = np.repeat([False, True, False], [len(before), len(body), len(after)])
    return ProfileBlock(Profile.concatenate([before, body, after]), is_body, sizes)
