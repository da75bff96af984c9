"""What every analytic surface can do."""

import abc

from ..types.arrays import Mask, Scalars, Vector


class AbstractSurface(abc.ABC):
    """A surface in front of the camera, given by its depth. Subclasses are final.

    World frame: x right, y down, z away from the camera, as the camera stands in the first frame.
    """

    @abc.abstractmethod
    def depth(self, x: Scalars, y: Scalars) -> Scalars:
        """Give the surface's z at x and y [m]; continued smoothly a little beyond its edge."""

    @abc.abstractmethod
    def covers(self, x: Scalars, y: Scalars) -> Mask:
        """Tell whether there is a surface at x and y [m]; beyond its edge all is dark."""

    @abc.abstractmethod
    def box(self) -> tuple[Vector, Vector]:
        """Give the lowest and the highest corner of a box around the surface [m]."""
