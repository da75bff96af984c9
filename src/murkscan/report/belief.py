"""How sure the extractor was that the points are the surface."""

import itertools
from dataclasses import dataclass

import numpy as np

from ..types.arrays import Ratios

LEVELS = (0.5, 0.7, 0.9, 0.99)
"""Posterior probabilities at which the points are parted."""


@dataclass(frozen=True)
class Belief:
    """How many points have a posterior below, between and above the levels."""

    counts: tuple[int, ...]
    """One more than there are levels; the least sure first."""
    is_told: bool
    """Whether the extractor tells them apart; one that does not says 1 of every point."""

    @classmethod
    def from_posterior(cls, posterior: Ratios) -> "Belief":
        """Count points by their posterior."""
        which = np.searchsorted(np.array(LEVELS, np.float32), posterior, side="right")
        counts = np.bincount(which, minlength=len(LEVELS) + 1)
        return cls(tuple(counts.tolist()), bool(np.any(posterior < 1)))

    def __add__(self, other: "Belief") -> "Belief":
        """Count both."""
        pairs = zip(self.counts, other.counts, strict=True)
        return Belief(tuple(a + b for a, b in pairs), self.is_told or other.is_told)

    @property
    def shares(self) -> tuple[float, ...]:
        """Share of the points of each count."""
        total = max(sum(self.counts), 1)
        return tuple(count / total for count in self.counts)


def name_classes() -> list[tuple[str, str]]:
    """Name each class of a belief: for a file, and for a reader."""
    first, last = LEVELS[0], LEVELS[-1]
    between = itertools.pairwise(LEVELS)
    return [
        (f"below_{first:g}", f"below {first:g}"),
        *((f"from_{low:g}_to_{high:g}", f"{low:g} to {high:g}") for low, high in between),
        (f"from_{last:g}", f"{last:g} and more"),
    ]
