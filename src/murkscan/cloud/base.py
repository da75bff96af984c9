"""What every rule against false points can do."""

import abc
from dataclasses import dataclass

from ..geometry.grid import ScanGrid
from ..types.arrays import Indices, Mask, Points
from ..types.cloud import PointCloud


@dataclass(frozen=True, eq=False)
class SeenCloud:
    """The points of a scan, and from where each was seen."""

    cloud: PointCloud
    cameras: Points
    """Optical centre of the camera when it saw each point, in the points' frame [m]."""

    def __getitem__(self, which: Mask | Indices) -> "SeenCloud":
        """Pick some of the points."""
        return SeenCloud(self.cloud[which], self.cameras[which])

    def lay_grid(self, *, max_jump: float | None = None) -> ScanGrid:
        """Lay the scan's own grid through the points; see `ScanGrid.from_cloud`."""
        return ScanGrid.from_cloud(self.cloud, max_jump=max_jump)


class AbstractOutlierRule(abc.ABC):
    """A reason not to believe a point. Subclasses are final: wrap one, do not subclass it."""

    @property
    @abc.abstractmethod
    def cause(self) -> str:
        """One word for what gives a false point away, as counts name it."""

    @abc.abstractmethod
    def find(self, seen: SeenCloud) -> Mask:
        """Find the false points of a scan.

        Args:
            seen: The points, in any order, of any number.

        Returns:
            Which of them are no surface.

        Raises:
            InputError: A point is not finite.
        """
