"""What every mesher can do."""

import abc
from collections.abc import Sequence

import numpy as np

from ..types.cloud import PointCloud
from ..types.mesh import Mesh


class AbstractMesher(abc.ABC):
    """A way to make a surface of points. Subclasses are final: wrap one, do not subclass it."""

    def check_available(self) -> None:  # noqa: B027  most meshers need nothing
        """Refuse now what `mesh` would refuse after an hour of other work.

        Raises:
            MissingDependency: The mesher needs an extra that is not installed.
        """

    @abc.abstractmethod
    def mesh(self, cloud: PointCloud) -> Mesh:
        """Make a surface of a scan's points.

        Args:
            cloud: The points with their normals, frames and scan lines; of any number.

        Returns:
            Triangles in the cloud's frame, counter-clockwise seen from where the camera was; every
            vertex belongs to a triangle. A cloud without two neighbouring profiles has none.

        Raises:
            InputError: A point is not finite.
        """

    def mesh_passes(self, passes: Sequence[PointCloud]) -> Mesh:
        """Make one surface of several passes over an object, in one frame.

        Args:
            passes: The points of each, as for `mesh`.

        Raises:
            InputError: A point is not finite.
        """
        return self.mesh(PointCloud.concatenate(passes))


def empty_mesh() -> Mesh:
    """Make the surface of a cloud that has none."""
    return Mesh(np.zeros((0, 3)), np.zeros((0, 3), np.int64))


def drop_unused_vertices(mesh: Mesh) -> Mesh:
    """Leave out the vertices that no triangle has; the order of the others stays."""
    used = np.zeros(len(mesh.vertices), bool)
    used[mesh.faces] = True
    number = np.cumsum(used) - 1
    colours = None if mesh.colours is None else mesh.colours[used]
    return Mesh(mesh.vertices[used], number[mesh.faces], mesh.filled, colours)
