"""Poisson surface reconstruction: closed over noise and small holes, cut where nothing was seen."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, final

import numpy as np
from scipy.spatial import cKDTree

from ..errors import InputError, MissingDependency
from ..geometry.grid import ScanGrid
from ..types.cloud import PointCloud
from ..types.mesh import Mesh
from .base import AbstractMesher, drop_unused_vertices, empty_mesh

if TYPE_CHECKING:
    from types import ModuleType

_MAX_DEPTH = 12
"""Depth above which the octree outgrows the memory of ordinary machines."""
_FEWEST = 4
"""Points below which there is no surface to fit."""
_SUPPORT = 2.0
"""Distance from the nearest point, in usual distances between profiles, up to which the surface
counts as seen."""


@final
@dataclass(frozen=True)
class Poisson(AbstractMesher):
    """The smooth surface whose gradient agrees best with the points' normals. Extra `[mesh]`.

    It evens out noise and closes small holes. What lies farther from every point than two usual
    distances between profiles is cut off.

    References:
        Kazhdan, Hoppe, Screened Poisson surface reconstruction, ACM Trans. Graph. 32(3), 2013.
    """

    depth: int = 8
    """Depth of the octree: the box is resolved into 2^depth cells a side. Deeper follows the noise:
    at 0.3 mm noise 8 is more accurate than 9."""

    def __post_init__(self) -> None:
        """Refuse a depth without shape or without end."""
        if not 1 <= self.depth <= _MAX_DEPTH:
            raise InputError(f"depth must lie from 1 to {_MAX_DEPTH}, got {self.depth}.")

    def check_available(self) -> None:
        """Refuse to begin without Open3D; see `AbstractMesher.check_available`."""
        _import_open3d()

    def mesh(self, cloud: PointCloud) -> Mesh:
        """Make the surface; its vertices lie near the points, not on them."""
        open3d = _import_open3d()
        grid = ScanGrid.from_cloud(cloud)
        with_normal = cloud[np.any(cloud.normals != 0, axis=1)]
        if len(with_normal) < _FEWEST or grid.usual_across == 0:
            return empty_mesh()
        mesh = _reconstruct(open3d, with_normal, self.depth)
        reach = _SUPPORT * max(grid.usual_across, grid.usual_along)
        return _trim(_face_normals(mesh, with_normal), cloud, reach)


def _import_open3d() -> "ModuleType":
    try:
        import open3d
    except (ImportError, OSError) as error:
        raise MissingDependency(
            'Poisson needs Open3D: pip install "murkscan[mesh]", or ".[mesh]" in a clone.'
            if isinstance(error, ModuleNotFoundError)
            else f"open3d is installed but does not load ({error}); on Debian and Ubuntu it needs "
            "apt-get install libusb-1.0-0."
        ) from error
    return open3d


def _reconstruct(open3d: Any, cloud: PointCloud, depth: int) -> Mesh:
    vector = open3d.utility.Vector3dVector
    cloud_there = open3d.geometry.PointCloud(vector(cloud.points))
    cloud_there.normals = vector(cloud.normals.astype(np.float64))
    # One thread: with more, the sums' order and so the last digits change from run to run.
    made, _ = open3d.geometry.TriangleMesh.create_from_point_cloud_poisson(
        cloud_there, depth=depth, n_threads=1
    )
    return Mesh(np.asarray(made.vertices), np.asarray(made.triangles).astype(np.int64))


def _face_normals(mesh: Mesh, cloud: PointCloud) -> Mesh:
    """Turn the whole surface so that most of it agrees with the normals of the nearest points."""
    a, b, c = (mesh.vertices[corner] for corner in mesh.faces.T)
    _, nearest = cKDTree(cloud.points).query((a + b + c) / 3)
    agree = np.einsum("ij,ij->i", np.cross(b - a, c - a), cloud.normals[nearest])
    return mesh if agree.sum() >= 0 else Mesh(mesh.vertices, mesh.faces[:, ::-1])


def _trim(mesh: Mesh, cloud: PointCloud, reach: float) -> Mesh:
    distance, _ = cKDTree(cloud.points).query(mesh.vertices)
    near = np.asarray(distance) <= reach
    seen = near[mesh.faces].all(axis=1)
    return drop_unused_vertices(Mesh(mesh.vertices, mesh.faces[seen]))
