"""A part of a scan's cloud, with what was taken out of it."""

from dataclasses import dataclass

import numpy as np

from .arrays import Mask, SmallNumbers
from .cloud import PointCloud
from .short_repr import ShortRepr


@dataclass(frozen=True, eq=False, repr=False)
class CloudPart(ShortRepr):
    """The points of one part of the profiles in the world frame, one for each that has a pose."""

    cloud: PointCloud
    """All of them, in the order of the profiles."""
    taken_out: SmallNumbers
    """0 where a point stays; else the number of the cause for which it was taken out, from 1."""
    causes: tuple[str, ...]
    """The causes, in order of their numbers."""

    @classmethod
    def whole(cls, cloud: PointCloud) -> "CloudPart":
        """Make a part of which every point stays."""
        return cls(cloud, np.zeros(len(cloud), np.uint8), ())

    def __getitem__(self, which: slice) -> "CloudPart":
        """Pick some of the points."""
        return CloudPart(self.cloud[which], self.taken_out[which], self.causes)

    @property
    def stays(self) -> Mask:
        """Which points the cloud keeps."""
        return self.taken_out == 0

    @property
    def kept(self) -> PointCloud:
        """The points that the cloud keeps."""
        return self.cloud[self.stays]

    def count(self, cause: str) -> int:
        """Count the points that were taken out for a cause."""
        numbers = [n for n, one in enumerate(self.causes, 1) if one == cause]
        return int(np.isin(self.taken_out, numbers).sum())
