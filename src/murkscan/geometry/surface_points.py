"""A surface as evenly spread points with normals: what alignment works on."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ..errors import InputError, NotEnoughData
from ..types.arrays import Directions, Indices, Mask, Points, Scalars
from ..types.cloud import PointCloud
from ..types.mesh import Mesh
from .voxels import VoxelGrid

_WANTED = 20_000
"""Points that a surface is thinned to unless told: more make alignment slower, hardly better."""
_MOST = 200_000
"""Points of a mesh beyond which a wanted spacing is not kept."""
_SEARCHED = 200_000
"""Points of a cloud, about, among which the nearest is looked for."""
_FEWEST = 30
"""Points below which there is no surface to align."""
_AROUND = 9
"""Points, itself among them, whose mean height a point is moved to."""
_ALIKE = 0.7
"""Cosine of the angle between normals of neighbours on one surface."""
_NEIGHBOURS = 20
"""Points through which a plane gives the normal where a cloud brings none."""


@dataclass(frozen=True, eq=False)
class SurfacePoints:
    """Points of a surface, about as far from one another everywhere; one a row."""

    points: Points
    """Positions [m]."""
    normals: Directions
    """Unit normals."""
    weights: Scalars
    """How much each counts, up to 1: less where it stands for few points of the cloud."""
    spacing: float
    """Usual distance between neighbours [m]."""
    is_oriented: bool = True
    """Whether normals point to the same side of the surface everywhere."""

    def __len__(self) -> int:
        """Count the points."""
        return len(self.points)

    @classmethod
    def from_cloud(cls, cloud: PointCloud, *, spacing: float | None = None) -> "SurfacePoints":
        """Thin a cloud; normals are those of the cloud, or of planes where it brings none.

        Args:
            cloud: The points of a scan.
            spacing: Distance between the points that stay [m]; for about 20,000 unless given.

        Raises:
            InputError: A point is not finite.
            NotEnoughData: Fewer than 30 points are left, or have a normal: points on a line have
                none.
        """
        broken = len(cloud) - int(np.isfinite(cloud.points).all(axis=1).sum())
        if broken:
            raise InputError(
                f"{broken} of {len(cloud)} points are not finite; leave them out of the cloud."
            )
        _require(len(cloud))
        spacing = spacing or _spacing_for(cloud.points, _WANTED)
        grid = VoxelGrid(cloud.points, spacing, np.round(cloud.points[0]))
        points = grid.sum(cloud.points) / grid.counts[:, None]
        _require(len(points))
        normals = grid.sum(np.nan_to_num(cloud.normals.astype(float)))
        length = np.linalg.norm(normals, axis=1)
        # Half of the normals of one cube may point elsewhere: there is an edge, and no normal.
        sound = length > 0.5 * grid.counts
        is_oriented = bool(sound.sum() >= 0.5 * len(points))
        if not is_oriented:
            normals, sound = _fit_normals(points)
            length = np.linalg.norm(normals, axis=1)
        weights = np.minimum(grid.counts / np.median(grid.counts), 1.0)
        normals = normals[sound] / length[sound, None]
        points, weights = points[sound], weights[sound]
        _require(len(points))
        level = _level(points, normals, weights, is_oriented=is_oriented)
        return cls(level, normals, weights, spacing, is_oriented)

    @classmethod
    def from_mesh(cls, mesh: Mesh, *, spacing: float | None = None) -> "SurfacePoints":
        """Spread points evenly over a mesh; the same ones every time.

        Args:
            mesh: The surface.
            spacing: Distance between the points [m]; for about 20,000 unless given, and larger
                where there would be more than 200,000.

        Raises:
            NotEnoughData: The mesh has no area.
        """
        import trimesh

        shape = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
        if not shape.area > 0:
            raise NotEnoughData("The mesh has no area, so there is nothing to align with.")
        most = _WANTED if spacing is None else _MOST
        spacing = max(spacing or 0.0, float(np.sqrt(shape.area / most)))
        count = max(int(shape.area / spacing**2), _FEWEST)
        points, faces = trimesh.sample.sample_surface(shape, 3 * count, seed=0)
        grid = VoxelGrid(np.asarray(points, float), spacing, np.round(points[0]))
        first = grid.order[grid.starts]
        normals = np.asarray(shape.face_normals)[faces[first]]
        weights = np.ones(len(first))
        return cls(_level(grid.points[first], normals, weights), normals, weights, spacing)


def nearest_in_cloud(cloud: PointCloud, places: Points) -> Indices:
    """Find the point nearest to each place, among at least 200,000 of a cloud or all of it."""
    step = max(len(cloud) // _SEARCHED, 1)
    return step * np.asarray(cKDTree(cloud.points[::step]).query(places)[1])


def _require(count: int) -> None:
    if count < _FEWEST:
        raise NotEnoughData(f"Need at least {_FEWEST} points to align a surface, got {count}.")


def _spacing_for(points: Points, wanted: int) -> float:
    """Give the distance at which about so many points cover the surface [m]."""
    extent = float(np.linalg.norm(np.ptp(points, axis=0)))
    coarse = max(extent / 64, 1e-6)
    return coarse * float(
        np.sqrt(max(len(VoxelGrid(points, coarse, np.round(points[0])).starts), 1) / wanted)
    )


def _level(
    points: Points, normals: Directions, weights: Scalars, *, is_oriented: bool = True
) -> Points:
    """Move each point along its normal to the mean height of its neighbours.

    A cube of which the surface cuts off a corner holds only what noise has carried there, and lies
    too high or too low; together with its neighbours it does not. What this takes off a curved
    surface it takes off in both clouds.
    """
    _, near = cKDTree(points).query(points, k=min(_AROUND, len(points)))
    heights = np.einsum("nkj,nj->nk", points[near] - points[:, None], normals)
    agree = np.einsum("nkj,nj->nk", normals[near], normals)
    # The other side of a thin plate is another surface, if sides are known.
    alike = agree if is_oriented else np.abs(agree)
    shares = np.where(alike > _ALIKE, weights[near], 0.0)
    mean = (heights * shares).sum(axis=1) / shares.sum(axis=1)
    return points + mean[:, None] * normals


def _fit_normals(points: Points) -> tuple[Directions, Mask]:
    """Fit a plane to the neighbours of each point; which way its normal points is open."""
    _, near = cKDTree(points).query(points, k=min(_NEIGHBOURS, len(points)))
    around = points[near] - points[near].mean(axis=1, keepdims=True)
    _, spread, axes = np.linalg.svd(around, full_matrices=False)
    return axes[:, 2], spread[:, 1] > 3 * spread[:, 2]
