"""Poisson surface reconstruction: closed over noise and small holes, cut where nothing was seen."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, final

import numpy as np
import scipy

from ..errors import Degenerate, InputError, MissingDependency
from ..geometry.grid import ScanGrid
from ..geometry.point_normals import complete_normals
from ..types.arrays import Points
from ..types.cloud import PointCloud
from ..types.mesh import Mesh
from .base import AbstractMesher, drop_unused_vertices, empty_mesh

if TYPE_CHECKING:
    from types import ModuleType

_NARROW = 1e-6
"""Width of a cloud, in its length, up to which it is a line: above what single precision leaves."""
_MAX_DEPTH = 12
"""Depth above which the octree outgrows the memory of ordinary machines."""
_FEWEST = 4
"""Points below which there is no surface to fit."""
_SUPPORT = 2.0
"""Distance from the nearest point, in usual distances between profiles, up to which the surface
counts as seen."""
_MOST_OF_ITSELF = 10
"""Depth that is taken unless told, at most: for a million points a minute, and 1 GB."""
_SCALE = 1.1
"""Side of the octree's box over the longest side of the points'."""
_NEIGHBOURS = 30
"""Points whose disc tells the spacing where nobody knows profiles."""
_PROBED = 10_000
"""Points at which it is looked at."""


@final
@dataclass(frozen=True)
class Poisson(AbstractMesher):
    """The smooth surface whose gradient agrees best with the points' normals. Extra `[mesh]`.

    It evens out noise and closes small holes. What lies farther from every point than two usual
    distances between profiles is cut off. It takes clouds of other programs, too, whose points know
    neither profiles nor, if need be, normals.

    References:
        Kazhdan, Hoppe, Screened Poisson surface reconstruction, ACM Trans. Graph. 32(3), 2013.
    """

    depth: int | None = None
    """Depth of the octree: the box is resolved into 2^depth cells a side. None: the cells are no
    larger than the usual distance between points, down to 10."""

    def __post_init__(self) -> None:
        """Refuse a depth without shape or without end."""
        if self.depth is not None and not 1 <= self.depth <= _MAX_DEPTH:
            raise InputError(f"depth must lie from 1 to {_MAX_DEPTH}, got {self.depth}.")

    def check_available(self) -> None:
        """Refuse to begin without Open3D; see `AbstractMesher.check_available`."""
        _import_open3d()

    def mesh(self, cloud: PointCloud) -> Mesh:
        """Make the surface; its vertices lie near the points, and stand for the nearest.

        Raises:
            Degenerate: Points that know no profiles lie on one line.
        """
        open3d = _import_open3d()
        grid = ScanGrid.from_cloud(cloud)
        if len(cloud) >= _FEWEST and not grid.is_numbered:
            _require_width(cloud.points[~grid.numbered])
            cloud = complete_normals(cloud, ~grid.numbered)
        with_normal = cloud[np.any(cloud.normals != 0, axis=1)]
        if len(with_normal) < _FEWEST:
            return empty_mesh()
        seen = _Seen.from_grid(grid)
        if not seen:
            return empty_mesh()
        spacing = min(one.spacing for one in seen)
        depth = _depth_for(with_normal.points, spacing) if self.depth is None else self.depth
        mesh = _reconstruct(open3d, with_normal, depth)
        trimmed = _trim(_face_normals(mesh, with_normal), seen)
        if not len(trimmed.vertices):
            return empty_mesh()
        nearest = np.asarray(scipy.spatial.cKDTree(cloud.points).query(trimmed.vertices)[1])
        return replace(trimmed, points=nearest.astype(np.int64))


def _require_width(points: Points) -> None:
    """Refuse points on one line: a surface through them could be turned about it at will."""
    off = points - points.mean(axis=0)
    _, across, along = np.sqrt(np.maximum(np.linalg.eigvalsh(off.T @ off), 0.0))
    if across <= _NARROW * along:
        raise Degenerate(
            f"The cloud's {len(points)} points lie on one line, through which there is no surface; "
            "give a scan of two profiles or more."
        )


@dataclass(frozen=True, eq=False)
class _Seen:
    """Points that know profiles, or those that do not, and the surface that they show."""

    points: Points
    spacing: float
    """Usual distance between them [m]."""
    reach: float
    """How far a surface reaches from them [m]."""

    @classmethod
    def from_grid(cls, grid: ScanGrid) -> list["_Seen"]:
        """Tell both kinds apart; a single profile shows no surface."""
        seen, scanned, others = [], grid.cloud[grid.numbered], grid.cloud.points[~grid.numbered]
        own = ScanGrid.from_cloud(scanned)
        if across := own.usual_across:
            reach = _SUPPORT * max(own.usual_along, across)
            seen.append(cls(scanned.points, math.sqrt(own.usual_along * across), reach))
        if len(others):
            some = others[:: max(len(others) // _PROBED, 1)]
            radii = scipy.spatial.cKDTree(others).query(some, k=[min(_NEIGHBOURS, len(others))])[0]
            disc = float(np.median(radii))
            seen.append(cls(others, disc * math.sqrt(math.pi / _NEIGHBOURS), disc))
        return [one for one in seen if one.spacing > 0]


def _depth_for(points: Points, spacing: float) -> int:
    side = _SCALE * float(np.ptp(points, axis=0).max())
    return min(max(math.ceil(math.log2(side / spacing)), 1), _MOST_OF_ITSELF)


def _import_open3d() -> "ModuleType":
    try:
        import open3d
    except (ImportError, OSError) as error:
        if isinstance(error, ModuleNotFoundError):
            raise MissingDependency.of("Poisson", "Open3D", "mesh") from error
        raise MissingDependency(
            f"open3d is installed but does not load ({error}); on Debian and Ubuntu it needs "
            "apt-get install libusb-1.0-0."
        ) from error
    return open3d


def _reconstruct(open3d: Any, cloud: PointCloud, depth: int) -> Mesh:
    vector = open3d.utility.Vector3dVector
    cloud_there = open3d.geometry.PointCloud(vector(cloud.points))
    cloud_there.normals = vector(cloud.normals.astype(np.float64))
    # One thread: with more, the sums' order and so the last digits change from run to run.
    made, _ = open3d.geometry.TriangleMesh.create_from_point_cloud_poisson(
        cloud_there, depth=depth, scale=_SCALE, n_threads=1
    )
    return Mesh(np.asarray(made.vertices), np.asarray(made.triangles).astype(np.int64))


def _face_normals(mesh: Mesh, cloud: PointCloud) -> Mesh:
    """Turn the whole surface so that most of it agrees with the normals of the nearest points."""
    a, b, c = (mesh.vertices[corner] for corner in mesh.faces.T)
    _, nearest = scipy.spatial.cKDTree(cloud.points).query((a + b + c) / 3)
    agree = np.einsum("ij,ij->i", np.cross(b - a, c - a), cloud.normals[nearest])
    return mesh if agree.sum() >= 0 else Mesh(mesh.vertices, mesh.faces[:, ::-1])


def _trim(mesh: Mesh, seen: Sequence[_Seen]) -> Mesh:
    near = np.zeros(len(mesh.vertices), bool)
    for one in seen:
        near |= np.asarray(scipy.spatial.cKDTree(one.points).query(mesh.vertices)[0]) <= one.reach
    return drop_unused_vertices(Mesh(mesh.vertices, mesh.faces[near[mesh.faces].all(axis=1)]))
