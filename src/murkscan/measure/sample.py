"""The points that a measure is taken of, and what is known of their errors."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from jaxtyping import Float

from ..errors import NotEnoughData
from ..geometry.grid import ScanGrid
from ..geometry.point_normals import complete_normals
from ..geometry.stripe_blur import Sight
from ..types.arrays import Indices, Mask, Points
from ..types.cloud import PointCloud
from .noise import usual_noise

_APART = 1000
"""Numbers between the last profile and the first row of places: they are no neighbours."""

Shifts = Float[np.ndarray, "n 3 modes"]
"""How far points move with each independent error of the rig, at one standard deviation [m]."""


@dataclass(frozen=True, eq=False)
class Sample:
    """Points of a scan; one a row."""

    cloud: PointCloud
    """The points, in the world."""
    profile: Indices
    """Number of each point's profile; those that follow one another differ by 1."""
    line: Indices
    """Number of each point's scan line."""
    rows: Indices
    """Number of each point in the scan's cloud."""
    sight: Sight | None = None
    """From where each was seen; None where nobody knows."""
    shifts: Callable[[Indices], Shifts] | None = None
    """Gives, in the world, how far some of the points move with the rig's errors; None where the
    rig states none."""
    num_alignments: int = 0
    """How many of these errors, the last ones, are those of a merged cloud's alignments."""

    @classmethod
    def from_cloud(
        cls,
        cloud: PointCloud,
        *,
        sight: Sight | None = None,
        shifts: Callable[[Indices], Shifts] | None = None,
        num_alignments: int = 0,
    ) -> "Sample":
        """Take all points of a cloud.

        Those of other programs, which know no profiles, are numbered by where they lie on the plane
        along which they spread most, and get normals where they have none.

        Args:
            cloud: The points.
            sight: From where each was seen.
            shifts: Gives how far points move with the rig's errors [m].
            num_alignments: How many of these, the last ones, are of alignments of passes.

        Raises:
            InputError: A point is not finite.
            NotEnoughData: There are no points.
        """
        if len(cloud) == 0:
            raise NotEnoughData(
                "The cloud has no points, so there is nothing to measure: look at extract/overlay "
                "to see what was found in the frames."
            )
        grid = ScanGrid.from_cloud(cloud)
        if grid.is_numbered:
            numbers = grid.profile, grid.line
        else:
            cloud = complete_normals(cloud, ~grid.numbered)
            numbers = _number_some(cloud, grid.numbered)
        return cls(cloud, *numbers, np.arange(len(cloud)), sight, shifts, num_alignments)

    def __len__(self) -> int:
        """Count the points."""
        return len(self.cloud)

    @cached_property
    def usual_noise(self) -> float:
        """The usual standard deviation of a point [m], which several measures ask for."""
        return usual_noise(self.cloud)

    def __getitem__(self, which: Mask) -> "Sample":
        """Pick some of the points."""
        numbers, shifts = np.flatnonzero(which), self.shifts
        return replace(
            self,
            cloud=self.cloud[which],
            profile=self.profile[which],
            line=self.line[which],
            rows=self.rows[which],
            sight=None if self.sight is None else self.sight[which],
            shifts=None if shifts is None else lambda some: shifts(numbers[some]),
        )


def _number_some(cloud: PointCloud, numbered: Mask) -> tuple[Indices, Indices]:
    """Give profile and scan line of the points that know them, and of the others their places."""
    known = ScanGrid.from_cloud(cloud[numbered])
    profile, line = np.zeros(len(cloud), np.int64), np.zeros(len(cloud), np.int64)
    profile[numbered], line[numbered] = known.profile, known.line
    row, column = _number_places(cloud.points[~numbered])
    profile[~numbered] = row + known.profile.max(initial=-_APART) + _APART
    line[~numbered] = column + known.line.min(initial=0)
    return profile, line


def _number_places(points: Points) -> tuple[Indices, Indices]:
    """Give row and column of each point among squares that hold about one."""
    off = points - points.mean(axis=0)
    axes = np.linalg.eigh(off.T @ off)[1][:, 1:]
    along = off @ axes
    extent = np.ptp(along, axis=0)
    side = max(float(np.sqrt(extent.prod() / len(points))), 1e-9)
    row, column = np.floor((along - along.min(axis=0)) / side).astype(np.int64).T
    return row, column
