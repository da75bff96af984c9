"""Where a stripe may be in a frame: ridges that stand out of the noise, a few a scan line."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from .._kernels.matched_filter import add_neighbour
from .._kernels.ridges import compare_ridges, find_blurred_ends, find_ridges
from ..types.arrays import Indices, Mask, Scalars
from .matched_filter import Scored
from .scan_lines import ScanLines

MOST = 6
"""Ridges a scan line; the highest are kept."""
_BOUND = 2.0
"""Standard deviations by which a neighbouring frame may exceed a frame's own score, so that snow
of that frame is none of this one's."""
_HALF_ROW = 0.66
"""Factor for the sum of two fields' rows around a missing one, whose noise is half correlated."""
_LOBE = 0.35
"""Share of a ridge's height that its own side lobes reach, with noise on them."""
_SURE = 8.0
"""Score from which a ridge is surely there, whatever it is."""
_LONG, _STEADY = 24, 3.0
"""Lines, and the step that parts them [px], from which ridges are no snow."""
_MUCH = 0.1
"""Share of the scan lines that long stripes must cover to tell anything."""

Marks = Bool[np.ndarray, "lines most"]


@dataclass(frozen=True, eq=False)
class Ridges:
    """The ridges of one frame, the highest of a scan line first."""

    lines: ScanLines
    positions: Float[np.ndarray, "lines most"]
    """Along the scan line [px of `lines`]."""
    heights: Float[np.ndarray, "lines most"]
    """Score [standard deviations]."""
    counts: Indices
    """Ridges that a line has; what is beyond has no meaning."""
    reach: int
    """Pixels from a ridge up to which it has side lobes."""

    @property
    def index(self) -> int:
        """Number of the frame in its recording."""
        return self.lines.index

    @property
    def exist(self) -> Marks:
        """Tell which entries are ridges."""
        return np.arange(MOST) < self.counts[:, None]

    def are_also_in(self, other: "Ridges", *, near: float, share: float = 0.33) -> Marks:
        """Tell which are in another frame, too, within `near` pixels and at a `share` of height."""
        shift, _ = self.lines.offset(other.lines)
        own = self.positions, self.heights, self.counts
        theirs = other.positions, other.heights, other.counts
        return compare_ridges(*own, *theirs, shift, near, share)

    def are_blurred_ends(self) -> Marks:
        """Tell which are a stripe's blur, beyond the edge where the stripe ends."""
        own = self.positions, self.heights, self.counts
        return find_blurred_ends(*own, 1.5, 0.5, 0.25, 4.0)

    def are_within(self, which: Marks, distance: float) -> Marks:
        """Tell which lie within a distance of one of some in their scan line [px of `lines`]."""
        places = np.where(which, self.positions, np.inf)
        apart = np.abs(self.positions[:, :, None] - places[:, None, :])
        return (apart < distance).any(axis=2)

    def agreement(self, other: "Ridges") -> float:
        """Give the share of long, sure stripes that another frame has, too; NaN where few are."""
        sure = self.exist[:, 0] & (self.heights[:, 0] > _SURE)
        long = find_runs(sure, self.positions[:, 0])
        if long.mean() < _MUCH:
            return math.nan
        return float(self.are_also_in(other, near=1.5)[long, 0].mean())


def find_runs(on: Mask, positions: Scalars) -> Mask:
    """Tell which scan lines lie in a long run of ridges that follow one another steadily.

    Args:
        on: Scan lines that have a ridge.
        positions: Where it is [px].
    """
    breaks = ~on[1:] | ~on[:-1] | (np.abs(np.diff(positions)) > _STEADY)
    ends = np.flatnonzero(np.r_[True, breaks, True])
    return on & np.repeat(np.diff(ends) >= _LONG, np.diff(ends))


def find_frame_ridges(near: Mapping[int, Scored], *, least: float, reach: int) -> Ridges:
    """Find the ridges of a frame, helped by those before and after it.

    A stripe that moves by less than its width from frame to frame adds up to a higher score; what
    is in one frame alone keeps its own.

    Args:
        near: The frame, 0, and those one before and after it, as far as there are any.
        least: Score that a ridge must reach.
        reach: Pixels from a ridge up to which it has side lobes.

    References:
        Curless and Levoy, Better optical triangulation through spacetime analysis, ICCV 1995, for
        the stripe as a ridge in time as well.
    """
    own = near[0]
    total = own.scores.copy()
    for other in (other for distance, other in near.items() if distance):
        down, across = _half_rows(own.lines, other.lines)
        add_neighbour(own.scores, other.scores, down, across, _BOUND, _HALF_ROW, total)
    total *= np.float32(1 / math.sqrt(len(near)))
    scores = np.maximum(total, own.scores)
    positions, heights, counts = find_ridges(scores, least, MOST, reach, _LOBE)
    return Ridges(own.lines, positions, heights, counts, reach)


def _half_rows(own: ScanLines, other: ScanLines) -> tuple[int, int]:
    """Give how far back a field's second row around one of the other field's lies, and line."""
    down, across = own.offset(other)
    return round(2 * down), round(2 * across)
