"""The samples of a scan, frame by scan line, with the gaps inside each frame filled and named."""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
from jaxtyping import Float, Int, UInt8

from ..types.arrays import Indices, Scalars

Grid = Float[np.ndarray, "h w"]
Numbers = Int[np.ndarray, "h w"]
Causes = UInt8[np.ndarray, "h w"]

CAUSES = (
    *("no_stripe", "unreadable", "too_fast", "too_far", "occluded"),
    *("too_dark", "far_or_dark"),
)
"""Why a piece of surface is missing."""
COVERED = 0
NO_STRIPE, UNREADABLE, TOO_FAST, TOO_FAR, OCCLUDED, TOO_DARK, FAR_OR_DARK = range(
    1, len(CAUSES) + 1
)
NO_LIGHT = 254
"""Where too little light came back, before the range tells why."""
NOTHING = 255
"""Where no profile says that there is a surface."""
_BESIDE = 4
"""Scan lines over which the slope beside a gap is taken."""


@dataclass(frozen=True, eq=False)
class Swath:
    """Samples on frames (rows) and scan lines (columns), NaN where there is none."""

    along: Grid
    """Place along the motion [m]."""
    across: Grid
    """Place across it [m]."""
    height: Grid
    """Place towards the scanner [m]."""
    depth: Grid
    """z in the camera frame [m]."""
    range: Grid
    """Distance from the camera [m]."""
    cause: Causes
    """COVERED where a point is, why one is missing inside a frame's stripe, or NOTHING."""
    frame: Numbers
    """Index of the sample's frame in the recording."""
    read: Numbers
    """How many frames were read before it."""
    lit: Numbers
    """How many of those had points."""
    camera: Grid
    """Place of the camera along the motion [m]."""

    def after(self, num_lit: int) -> "Swath":
        """Count on from so many frames that had points."""
        return replace(self, lit=self.lit + num_lit)

    def pitch(self) -> float:
        """Give the distance of neighbouring scan lines for each metre of depth; 0 without any.

        That of a pinhole is the same all over: x = z (u - cx) / f.
        """
        is_point = self.cause == COVERED
        pairs = is_point[:, 1:] & is_point[:, :-1]
        steps = np.abs(np.diff(self.across, axis=1))[pairs] / self.depth[:, 1:][pairs]
        return float(np.median(steps)) if steps.size else 0.0

    def append_to(self, before: "Swath | None") -> "Swath":
        """Put the rows after those of another part."""
        if before is None:
            return self
        names = [column.name for column in fields(self)]
        return Swath(*(np.concatenate([getattr(before, n), getattr(self, n)]) for n in names))

    def last_of_each_line(self) -> "Swath":
        """Keep the last sample of each scan line, in one row."""
        is_there = self.cause != NOTHING
        last = len(is_there) - 1 - np.argmax(is_there[::-1], axis=0)
        columns = np.arange(is_there.shape[1])
        names = [column.name for column in fields(self)]
        return Swath(*(getattr(self, n)[last, columns][None] for n in names))


def put_on_grids(
    columns: Sequence[Scalars], row: Indices, line: Indices, shape: tuple[int, int]
) -> list[Grid]:
    """Put columns of samples on their rows and scan lines, NaN elsewhere."""
    grids = []
    for values in columns:
        grid = np.full(shape, np.nan)
        grid[row, line] = values
        grids.append(grid)
    return grids


def fill_rows(grids: Sequence[Grid], *, hole: float) -> tuple[list[Grid], Causes]:
    """Fill the gaps between the points of each row, and say why they are there.

    A gap counts as covered up to the length of a hole. Above that it is hidden behind an edge where
    the surface jumps by more than the gap is wide, and does not rise as steeply beside the gap;
    otherwise too little light came back.

    Args:
        grids: Along, across and height [m], and others that are filled alike.
        hole: Distance of neighbours above which there is a hole between them [m].
    """
    is_point = np.isfinite(grids[0])
    columns = np.broadcast_to(np.arange(is_point.shape[1]), is_point.shape)
    before = np.maximum.accumulate(np.where(is_point, columns, -1), axis=1)
    last = is_point.shape[1]
    after = np.minimum.accumulate(np.where(is_point, columns, last)[:, ::-1], axis=1)[:, ::-1]
    cause = np.where(is_point, COVERED, NOTHING).astype(np.uint8)
    rows, gaps = np.nonzero(~is_point & (before >= 0) & (after < last))
    left, right = before[rows, gaps], after[rows, gaps]
    share = (gaps - left) / np.maximum(right - left, 1)
    steps = [grid[rows, right] - grid[rows, left] for grid in grids]
    filled = [grid.copy() for grid in grids]
    for grid, step in zip(filled, steps, strict=True):
        grid[rows, gaps] = grid[rows, left] + share * step
    slope = (_slopes(grids, rows, left, -1) + _slopes(grids, rows, right, 1)) / 2
    width, jump = np.abs(steps[1]), np.abs(steps[2])
    is_jump = (jump > width) & (np.abs(steps[2] - slope * steps[1]) > jump / 2)
    cause[rows, gaps] = np.where(
        np.hypot(steps[0], width) <= hole, COVERED, np.where(is_jump, OCCLUDED, NO_LIGHT)
    )
    return filled, cause


def _slopes(grids: Sequence[Grid], rows: Indices, at: Indices, way: int) -> Scalars:
    """Give how steeply the surface rises across, on one side of points; 0 where nothing says."""
    _, across, height, *_ = grids
    other = np.clip(at + way * _BESIDE, 0, across.shape[1] - 1)
    run = across[rows, other] - across[rows, at]
    rise = height[rows, other] - height[rows, at]
    is_known = np.isfinite(run) & (run != 0)
    return np.where(is_known, rise / np.where(is_known, run, 1.0), 0.0)
