"""Where a stripe may be in a frame: ridges that stand out of the noise, a few a scan line."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float, Int8

from .._kernels.blurred_ends import find_blurred_ends
from .._kernels.matched_filter import add_neighbours
from .._kernels.ridges import (
    are_near,
    compare_ridges,
    drop_hidden,
    find_ridges,
    merge_ridges,
    pool_along,
    replace_near,
)
from ..types.arrays import Indices, Mask, Scalars
from .edges import weigh_edges
from .matched_filter import FilterBank, Scored
from .plateaus import list_plateaus
from .scan_lines import ScanLines

_NARROW = 0.3
"""Share of a wider filter's answer from which the narrower one tells where the stripe is. A stripe
answers a filter of half its width with 0.27 of what its own gives and less; the skirt of a narrow
one, scattered by murk, answers wide filters up to twice as much as the core its own."""
_BOUND = 2.0
"""Standard deviations by which a neighbouring frame may exceed a frame's own score, so that snow
of that frame is none of this one's."""
_HALF_ROW = 0.66
"""Factor for the sum of two fields' rows around a missing one, whose noise is half correlated."""
_LOBE = 0.35
"""Share of a ridge's height that its own side lobes reach, with noise on them."""
_FAINT, _MARGIN = 2.5, 1.2
"""Score from which a ridge may be a stripe's blur, and how much higher than expected such blur may
be: where a stripe is rolled by 45° it is 1.2 times as high. At c = 1.5 /m, 1.4 loses one in 230 of
the true centres more, and 1.0 gives one in 550 more that are false (benchmarks/murk.py, seed 0)."""
_SURE = 8.0
"""Score from which a ridge is surely there, whatever it is."""
_LONG, _STEADY, _MISSING = 24, 3.0, 4
"""Lines, and the step that parts them [px], from which ridges are no snow; and the lines that a
faint stripe may lack at once."""
_MUCH = 0.1
"""Share of the scan lines that long stripes must cover to tell anything."""
_SHAPED = 3.0
"""Score from which a ridge's shape shows through the noise: at 4.5 more edges of paper and of a
board's squares are followed (benchmarks/real.py, fitted sets)."""

PLATEAU = -1
"""Shape of a ridge that is a plateau of white."""
_RIM_OF_WHITE = 4.0
"""Pixels beside a plateau within which its flanks answer the filters."""

Marks = Bool[np.ndarray, "lines most"]


@dataclass(frozen=True, eq=False)
class Ridges:
    """The ridges of one frame, the highest of a scan line first."""

    lines: ScanLines
    positions: Float[np.ndarray, "lines most"]
    """Along the scan line [px of the frame's image]."""
    heights: Float[np.ndarray, "lines most"]
    """Score [standard deviations]."""
    counts: Indices
    """Ridges that a line has; what is beyond has no meaning."""
    shapes: Int8[np.ndarray, "lines most"]
    """Number of the filter that answers best."""
    grains: Float[np.ndarray, "lines most"]
    """Pixels that this filter averages: positions are no finer."""
    reach: float
    """Pixels from a ridge of the commonest width up to which it has side lobes."""
    tails: Float[np.ndarray, "shapes steps"]
    """How high a stripe's blur is so many scan lines beyond its end, as a share of its height."""
    edges: Float[np.ndarray, "lines most"]
    """Logarithm of the likelihood ratio against an edge between bright and dark, 0 at most."""

    @property
    def index(self) -> int:
        """Number of the frame in its recording."""
        return self.lines.index

    def bare(self) -> "Ridges":
        """Give the same without the pictures that they were found in, but for the frame's own."""
        lines = self.lines
        return replace(self, lines=ScanLines.bare(lines.frame, lines.axis, slope=lines.slope))

    @cached_property
    def exist(self) -> Marks:
        """Tell which entries are ridges."""
        return np.arange(self.positions.shape[1]) < self.counts[:, None]

    @cached_property
    def straight(self) -> Float[np.ndarray, "lines most"]:
        """Positions from those of an even wall: what follows a surface steps little."""
        return self.positions - self._slope * np.arange(len(self.counts))[:, None]

    @property
    def _slope(self) -> float:
        """Pixels of the frame's image from one scan line to the next of an even wall's stripe."""
        lines = self.lines
        return lines.slope * lines.line_step * lines.binning / lines.stretch

    def are_also_in(self, other: "Ridges", *, near: float, share: float = 0.33) -> Marks:
        """Tell which are in another frame, too, within `near` pixels and at a `share` of height."""
        shift, _ = self.lines.offset(other.lines)
        own = self.positions, self.heights, self.counts, self.grains
        theirs = other.positions, other.heights, other.counts
        return compare_ridges(*own, *theirs, shift, near, share)

    def are_blurred_ends(self) -> Marks:
        """Tell which are a stripe's blur, beyond the edge where the stripe ends."""
        own = self.positions, self.heights, self.counts, self.shapes
        return find_blurred_ends(*own, self.tails, self._slope, _FAINT, _MARGIN)

    def are_within(self, which: Marks, distance: float) -> Marks:
        """Tell which lie within a distance of one of some in their scan line [px of `lines`]."""
        return are_near(self.positions, which, distance)

    def are_long(self, which: Marks) -> Marks:
        """Tell which of some are the highest of their line and go on over many lines."""
        heights = np.where(which, self.heights, 0.0)
        best, every = np.argmax(heights, axis=1), np.arange(len(heights))
        marks = np.zeros(which.shape, bool)
        marks[every, best] = find_runs(which[every, best], self.straight[every, best])
        return marks

    def are_in_lines(self, which: Marks) -> Marks:
        """Tell which of some follow one another over many lines, a few of which may lack them."""
        return which & (self._count_along(which, 2 * _LONG, 1.0, _MISSING) >= _LONG + _MISSING)

    def _count_along(
        self, which: Marks, reach: int, steep: float, gap: int
    ) -> Float[np.ndarray, "lines most"]:
        """Count those of some that follow one another from each of them; see `pool_along`."""
        ones = np.ones(which.shape)
        return pool_along(self.straight, self.counts, which, ones, reach, steep, gap)

    def go_on(self, which: Marks) -> tuple[Marks, Float[np.ndarray, "lines most"]]:
        """Tell which of some have another within a grain in the next line, and how many would.

        Gives the number of those that lie so near by chance as well.
        """
        places = np.where(which, self.straight, np.inf)[1:, None, :]
        near = np.abs(self.straight[:-1, :, None] - places) < self.grains[:-1, :, None]
        marks, chance = np.zeros(which.shape, bool), np.zeros(which.shape)
        marks[:-1] = which[:-1] & near.any(axis=2)
        density = which.sum(axis=1) / len(self.lines.levels)
        chance[:-1] = 2.0 * self.grains[:-1] * density[1:, None]
        return marks, chance

    def are_beside(self, which: Marks) -> Marks:
        """Tell which have one of some within a grain in a scan line beside theirs."""
        places = np.where(which, self.straight, np.inf)
        marks = np.zeros(which.shape, bool)
        for own, other in ((slice(1, None), slice(-1)), (slice(-1), slice(1, None))):
            apart = np.abs(self.straight[own, :, None] - places[other, None, :])
            marks[own] |= (apart < self.grains[own, :, None]).any(axis=2)
        return marks

    def chance_of(
        self, other: "Ridges", *, near: float, share: float = 0.33
    ) -> Float[np.ndarray, "lines most"]:
        """Compute how probably each is in another frame by chance; see `are_also_in`."""
        tops = np.where(other.exist, other.heights, 0.0)[:, None, :]
        high = (tops > share * self.heights[:, :, None]).sum(axis=2)
        return 1.0 - np.exp(-2.0 * near * self.grains * high / len(self.lines.levels))

    def agreement(self, other: "Ridges") -> float:
        """Give the share of long, sure stripes that another frame has, too; NaN where few are."""
        known = self._agreements
        if other.index not in known:
            known[other.index] = self._agree(other)
        return known[other.index]

    @cached_property
    def _agreements(self) -> dict[int, float]:
        """With other frames of the recording, by their numbers: each pair is asked for often."""
        return {}

    def _agree(self, other: "Ridges") -> float:
        long = self.are_sure_and_long
        if long.any(axis=1).mean() < _MUCH:
            return math.nan
        return float(self.are_also_in(other, near=1.5)[long].mean())

    @cached_property
    def are_sure_and_long(self) -> Marks:
        """Tell which are sure and part of a line that follows itself over many scan lines."""
        sure = self.exist & (self.heights > _SURE)
        return sure & (self._count_along(sure, _LONG, _STEADY - 1.0, 0) >= _LONG)


def find_runs(on: Mask, positions: Scalars, *, least: float = _LONG) -> Mask:
    """Tell which scan lines lie in a long run of ridges that follow one another steadily.

    Args:
        on: Scan lines that have a ridge.
        positions: Where it is, from where an even wall would be [px].
        least: Scan lines of the shortest long run.
    """
    breaks = ~on[1:] | ~on[:-1] | (np.abs(np.diff(positions)) > _STEADY)
    ends = np.flatnonzero(np.r_[True, breaks, True])
    return on & np.repeat(np.diff(ends) >= least, np.diff(ends))


def find_frame_ridges(near: Mapping[int, Scored], bank: FilterBank) -> Ridges:
    """Find the ridges of a frame, helped by those before and after it.

    A stripe that moves by less than its width from frame to frame adds up to a higher score; what
    is in one frame alone keeps its own. Of what answers several filters, the narrowest counts that
    answers about as well as any.

    Args:
        near: The frame, 0, and those one before and after it, as far as there are any.
        bank: The filters, and how deep is looked.

    References:
        Curless and Levoy, Better optical triangulation through spacetime analysis, ICCV 1995, for
        the stripe as a ridge in time as well. Lindeberg, Edge detection and ridge detection with
        automatic scale selection, IJCV 30(2), 1998, for ridges of several widths.
    """
    own = near[0]
    parts = [_find_one_width(near, bank, number) for number in range(len(bank.filters))]
    if len(parts) == 1:
        positions, heights, counts = parts[0]
        shapes = np.zeros(positions.shape, np.int8)
    else:
        widths = np.array([each.width * each.binning for each in bank.filters])
        stacked = [np.stack(column) for column in zip(*parts, strict=True)]
        positions, heights, counts, shapes = merge_ridges(
            *stacked, widths, np.argsort(-widths), _NARROW
        )
    _add_plateaus(own.lines, bank, positions, heights, counts, shapes)
    if own.lines.hidden is not None:
        drop_hidden(positions, heights, counts, shapes, own.lines.hidden)
    # Few lines have as many ridges as are looked for: what none has is carried along no further.
    most = max(int(counts.max(initial=0)), 1)
    positions, heights, shapes = (
        np.ascontiguousarray(each[:, :most]) for each in (positions, heights, shapes)
    )
    grains = np.array([*(float(each.binning) for each in bank.filters), 1.0])[shapes]
    reach = float(bank.filters[0].reach * bank.filters[0].binning)
    tails, edges = bank.tails(own.lines), np.zeros(positions.shape)
    found = Ridges(own.lines, positions, heights, counts, shapes, grains, reach, tails, edges)
    for number, matched in enumerate(bank.filters):
        line, which = np.nonzero(found.exist & (shapes == number) & (heights > _SHAPED))
        at, height = positions[line, which], heights[line, which]
        edges[line, which] = weigh_edges(own.lines, matched, line, at, height)
    return found


def _add_plateaus(
    lines: ScanLines,
    bank: FilterBank,
    positions: Float[np.ndarray, "lines most"],
    heights: Float[np.ndarray, "lines most"],
    counts: Indices,
    shapes: Int8[np.ndarray, "lines most"],
) -> None:
    """Put white plateaus among the ridges, with a shape of their own: what is near is their rim."""
    line, found = list_plateaus(lines, bank.noise)
    if len(line) == 0:
        return
    middle, _, rise, width = np.ascontiguousarray(found.T)
    noise = bank.filters[0].noise.variance(bank.noise.white - rise)
    tops = rise * np.sqrt(width / noise)
    reaches = 0.5 * width + np.maximum(0.5 * width, _RIM_OF_WHITE)
    replace_near(positions, heights, counts, shapes, line, middle, tops, reaches, PLATEAU)


def _find_one_width(
    near: Mapping[int, Scored], bank: FilterBank, number: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Find what answers one filter: positions [px of the frame's image], heights and counts."""
    matched = bank.filters[number]
    scores = near[0].scores[number]
    if len(near) > 1:
        sides = [near.get(-1, near[0]), near.get(1, near[0])]
        rows = [_half_rows(near[0].lines, side.lines, matched.binning) for side in sides]
        back = np.column_stack([[-1 in near, 1 in near], rows])
        before, after = (side.scores[number] for side in sides)
        scores = add_neighbours(scores, before, after, back, _BOUND, _HALF_ROW)
    least, most = bank.search.least, bank.search.most
    margin = min(bank.search.rim * matched.width, (len(scores) - 3) / 2)
    positions, heights, counts = find_ridges(scores, least, most, matched.reach, _LOBE, margin)
    return matched.binning * positions + 0.5 * (matched.binning - 1), heights, counts


def _half_rows(own: ScanLines, other: ScanLines, binning: int) -> tuple[int, int]:
    """Compute how far a field's second row around one of the other's lies back, and which line."""
    down, across = own.offset(other)
    # Averaged pixels of both fields cover nearly the same place.
    return (round(2 * down) if binning == 1 else 0), round(2 * across)
