"""What every mesher can do."""

import abc
from collections.abc import Iterable, Sequence
from typing import ClassVar

import numpy as np

from ..types.cloud import PointCloud
from ..types.mesh import Mesh


class AbstractMesher(abc.ABC):
    """A way to make a surface of points. Subclasses are final: wrap one, do not subclass it."""

    works_in_tiles: ClassVar[bool] = False
    """Whether parts of a surface can be made by themselves, so that several can be at work."""

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
            vertex belongs to a triangle and knows its point. A cloud without two neighbouring
            profiles has none.

        Raises:
            InputError: A point is not finite.
        """

    def mesh_tile(self, cloud: PointCloud, own: slice) -> Mesh:
        """Make a part of the surface, where `works_in_tiles`; see `GridMesh.mesh_tile`."""
        raise NotImplementedError

    def mesh_passes(self, passes: Sequence[PointCloud]) -> Mesh:
        """Make one surface of several passes over an object, in one frame.

        Args:
            passes: The points of each, as for `mesh`.

        Raises:
            InputError: A point is not finite.
        """
        return self.mesh(PointCloud.concatenate(passes))


def join_tiles(tiles: Iterable[Mesh]) -> Mesh:
    """Make one surface of its tiles in order, of which each has all of its own points.

    The corners of their triangles may be points of the next tile: they are counted on.
    """
    vertices, faces, start = [np.zeros((0, 3))], [np.zeros((0, 3), np.int64)], 0
    for tile in tiles:
        vertices.append(tile.vertices)
        faces.append(tile.faces + start)
        start += len(tile.vertices)
    whole = Mesh(np.concatenate(vertices), np.concatenate(faces), points=np.arange(start))
    return drop_unused_vertices(whole)


def empty_mesh() -> Mesh:
    """Make the surface of a cloud that has none."""
    none = np.zeros((0, 3), np.int64)
    return Mesh(np.zeros((0, 3)), none, points=np.zeros(0, np.int64))


def drop_unused_vertices(mesh: Mesh) -> Mesh:
    """Leave out the vertices that no triangle has; the order of the others stays."""
    used = np.zeros(len(mesh.vertices), bool)
    used[mesh.faces] = True
    number = np.cumsum(used) - 1
    colours = None if mesh.colours is None else mesh.colours[used]
    points = None if mesh.points is None else mesh.points[used]
    return Mesh(mesh.vertices[used], number[mesh.faces], mesh.filled, colours, points)
