"""What every mesher can do."""

import abc

import numpy as np

from ..errors import NotEnoughData
from ..types.cloud import PointCloud
from ..types.mesh import Mesh


class AbstractMesher(abc.ABC):
    """A way to make a surface of points. Subclasses are final: wrap one, do not subclass it."""

    @abc.abstractmethod
    def mesh(self, cloud: PointCloud) -> Mesh:
        """Make a surface of a scan's points.

        Args:
            cloud: The points with their normals, frames and scan lines.

        Returns:
            Triangles in the cloud's frame, counter-clockwise seen from where the camera was; every
            vertex belongs to a triangle.

        Raises:
            NotEnoughData: The cloud is empty, has one profile only, or gives no triangle.
            InputError: A point is not finite.
        """


def require_profiles(cloud: PointCloud) -> None:
    """Refuse a cloud that can have no surface.

    Raises:
        NotEnoughData: It has fewer than two profiles.
    """
    num_profiles = len(np.unique(cloud.frame))
    if num_profiles < 2:
        raise NotEnoughData(
            f"A surface needs points of at least 2 frames, got {len(cloud)} points of "
            f"{num_profiles}. Record the object while the rig moves across it."
        )


def drop_unused_vertices(mesh: Mesh) -> Mesh:
    """Leave out the vertices that no triangle has; the order of the others stays."""
    used = np.zeros(len(mesh.vertices), bool)
    used[mesh.faces] = True
    number = np.cumsum(used) - 1
    return Mesh(mesh.vertices[used], number[mesh.faces])
