"""The scan's own grid: which point lies next to which, along a profile and across to the next.

Along the stripe points lie tenths of a millimetre apart, from one profile to the next millimetres
or centimetres, so the nearest points in space all belong to one profile. Their numbers know
better::

                 scan line ──▶
        profile   · · · · · · ·     along: the next scan line of the same profile
           │      · · · · · · ·     across: the same scan line of the next profile
           ▼      · · · · · · ·
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .._kernels.cells import find_in_cells
from ..errors import InputError
from ..types.arrays import Indices, Mask, Scalars
from ..types.cloud import PointCloud

NONE = -1
"""Stands for a neighbour that is not there."""
_MARGIN = 4
"""Empty rows and columns between the cells, so that no offset up to this wraps around."""
_MAX_BRANCHES = 8
"""Points of one cell that are looked at; a stripe has hardly ever more than three branches."""
_STEEPEST = 5.0
"""Distance between neighbours, in usual ones, above which they lie on two surfaces: a surface
turned by 78 degrees still holds together."""
_SIGMAS = 4.0
"""Standard deviations of the distance between two points that noise alone may add to it."""
_FARTHEST = 1e8
"""Distance from the origin beyond which a place is none [m]: coordinates of maps, and of the
Earth's middle, stay below."""
_FIELD_SHARE = 0.8
"""Share of a profile's scan lines of one parity above which it is a field of an interlaced
picture; the rest are centres that a finder has moved by half a line."""


@dataclass(frozen=True, eq=False)
class ScanGrid:
    """Points of a cloud in cells of profile and scan line; a cell holds one point a branch."""

    cloud: PointCloud
    """The points."""
    profile: Indices
    """Number of each point's profile; from one laser to the next it jumps."""
    line: Indices
    """Number of each point's scan line in its profile: of an interlaced recording, the field's."""
    max_jump: float | None = None
    """Largest distance between neighbours on one surface [m]; None: told from the points."""

    @classmethod
    def from_cloud(cls, cloud: PointCloud, *, max_jump: float | None = None) -> "ScanGrid":
        """Lay the grid through a cloud.

        Args:
            cloud: The points, in any order.
            max_jump: Largest distance between neighbours on one surface [m]. None: five times the
                usual distance in that direction, and four standard deviations.

        Raises:
            InputError: A point is not finite or off this Earth, or max_jump is not positive.
        """
        broken = len(cloud) - int(np.isfinite(cloud.points).all(axis=1).sum())
        if broken:
            raise InputError(
                f"{broken} of {len(cloud)} points are not finite; leave them out of the cloud."
            )
        farthest = float(np.abs(cloud.points).max(initial=0.0))
        if farthest > _FARTHEST:
            raise InputError(
                f"The cloud has points {farthest:.3g} m from its origin, farther than any place on "
                "Earth; leave them out, or give the cloud in metres."
            )
        if max_jump is not None and not max_jump > 0:
            raise InputError(f"max_jump must be above 0, got {max_jump:g} m.")
        profile = _number_profiles(cloud.frame)
        profile += cloud.laser * (profile.max(initial=0) + 2 * _MARGIN)
        line = cloud.scan_line.astype(np.int64)
        return cls(cloud, profile, line // line_step(profile, line), max_jump)

    @cached_property
    def _width(self) -> int:
        """Cells from one profile to the same scan line of the next."""
        return int(np.ptp(self.line)) + 2 * _MARGIN if len(self.line) else _MARGIN

    @cached_property
    def _cells(self) -> tuple[Indices, Indices, Indices]:
        """Give each point's cell, and the cells in increasing order with their points."""
        cell = self.profile * self._width + self.line
        order = np.argsort(cell, kind="stable")
        return cell, cell[order], order

    @cached_property
    def numbered(self) -> Mask:
        """Which points say where in the grid they are; those of other programs do not.

        A scan's profile has in no cell more points than a stripe has branches. Each profile is
        judged by itself: passes of a merged cloud may differ.
        """
        _, which = np.unique(self.profile, return_inverse=True)
        line = self.cloud.scan_line.astype(np.int64)
        width = int(np.ptp(line)) + 1 if len(line) else 1
        _, first = np.unique(which * width + line, return_index=True)
        num_cells = np.bincount(which[first])
        return (np.bincount(which) <= _MAX_BRANCHES * num_cells)[which]

    @property
    def is_numbered(self) -> bool:
        """Whether all points say where in the grid they are."""
        return bool(self.numbered.all())

    @cached_property
    def usual_along(self) -> float:
        """Median distance between neighbours in a profile [m]; 0 where there are none."""
        return self._usual(0, 1)

    @cached_property
    def usual_across(self) -> float:
        """Median distance between neighbours in two profiles [m]; 0 where there are none."""
        return self._usual(1, 0)

    def nearest(self, profiles: int, lines: int, of: Indices | None = None) -> Indices:
        """Find the point of another cell that is nearest in space.

        Args:
            profiles: How many profiles on, -3 to 3.
            lines: How many scan lines on, -3 to 3.
            of: The points that ask; all of them by default.

        Returns:
            For each point that asks the number of its neighbour; NONE where the cell is empty.
        """
        asking = np.arange(len(self.cloud)) if of is None else of
        cell, cells, order = self._cells
        wanted = cell[asking] + profiles * self._width + lines
        return find_in_cells(self.cloud.points, asking, wanted, cells, order, _MAX_BRANCHES)

    def distance(self, ours: Indices, theirs: Indices) -> Scalars:
        """Measure from points to points [m]."""
        between = self.cloud.points[theirs] - self.cloud.points[ours]
        return np.sqrt(np.einsum("ij,ij->i", between, between))

    def touches(self, ours: Indices, theirs: Indices, profiles: int, lines: int) -> Mask:
        """Tell which pairs lie on one surface; a pair with a NONE does not.

        Args:
            ours: Points.
            theirs: One of each point's neighbours.
            profiles: Profiles between the two.
            lines: Scan lines between the two.
        """
        if self.max_jump is None:
            usual = abs(profiles) * self.usual_across + abs(lines) * self.usual_along
            noise = np.hypot(self.cloud.sigma[ours], self.cloud.sigma[theirs])
            limit = _STEEPEST * usual + _SIGMAS * np.nan_to_num(noise, posinf=0.0)
        else:
            limit = np.full(len(ours), self.max_jump)
        return (theirs != NONE) & (self.distance(ours, theirs) <= limit)

    def linked(self, profiles: int, lines: int) -> Indices:
        """Find each point's neighbour on the same surface, in one direction.

        Both must be the other's nearest, so that each point has one neighbour a side.

        Args:
            profiles: How many profiles on: 1 for across, otherwise 0.
            lines: How many scan lines on: 1 for along, otherwise 0.

        Returns:
            The number of each point's neighbour, or NONE.
        """
        there, back = self.nearest(profiles, lines), self.nearest(-profiles, -lines)
        here = np.arange(len(there))
        mutual = (there != NONE) & (back[there] == here)
        return np.where(mutual & self.touches(here, there, profiles, lines), there, NONE)

    def _usual(self, profiles: int, lines: int) -> float:
        there = self.nearest(profiles, lines)
        here = np.flatnonzero(there != NONE)
        return float(np.median(self.distance(here, there[here]))) if here.size else 0.0


def reverse_links(links: Indices) -> Indices:
    """Give each point the one that is linked to it: the neighbour on the other side."""
    back = np.full(len(links), NONE)
    here = np.flatnonzero(links != NONE)
    back[links[here]] = here
    return back


def _number_profiles(frame: np.ndarray) -> Indices:
    """Number the profiles so that those that follow one another differ by 1.

    A recording may be scanned every few frames; frames that are missing leave a gap.
    """
    frames, which = np.unique(frame, return_inverse=True)
    steps = np.diff(frames.astype(np.int64))
    usual = np.median(steps) if steps.size else 1
    numbers = np.concatenate([[0], np.cumsum(np.maximum(np.rint(steps / usual), 1))])
    return numbers.astype(np.int64)[which]


def line_step(profile: Indices, line: Indices) -> int:
    """Tell how many image rows lie between two scan lines: 2 in the fields of interlaced video.

    Rows then are even in one field and odd in the other; halved, both have the same numbers, and
    neighbours across are half a scan line apart, which no triangle minds.

    Args:
        profile: Number of each point's profile, from 0.
        line: Image row or column of each point [px].
    """
    total = np.bincount(profile)
    odd = np.bincount(profile, weights=line % 2)
    of_one_parity = np.maximum(odd, total - odd).sum()
    return 2 if of_one_parity > _FIELD_SHARE * total.sum() and np.any(total > _MARGIN) else 1
