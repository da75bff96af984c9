"""Triangles between neighbouring profiles: the surface exactly as it was scanned."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, final

import numpy as np

from ..errors import InputError
from ..geometry.grid import NONE, ScanGrid, reverse_links
from ..types.arrays import Faces, Indices
from ..types.cloud import PointCloud
from ..types.mesh import Mesh
from .base import AbstractMesher, empty_mesh, join_tiles
from .one_sheet import join_sheets
from .smooth import smooth_points


@final
@dataclass(frozen=True)
class GridMesh(AbstractMesher):
    r"""Join each point to its neighbours along its profile and across to the next one.

    Every vertex is a measured point, moved along its normal by no more than its standard deviation,
    to where its neighbours say that it lies. The surface is cut at depth jumps and open where a
    profile or a scan line is missing. Four neighbours make two triangles, three make one::

        a --- b                                              a --- b
        | \   |      split along the shorter diagonal        |   /
        c --- d                                              c      (d is missing)
    """

    max_jump: float | None = None
    """Largest distance between neighbours on one surface [m]. None: five times the usual distance
    in that direction, and four standard deviations of the points."""
    smoothing: float = 1.0
    """How far a vertex may move to even out noise, in its own standard deviations, up to 1; 0 keeps
    the measured points."""

    works_in_tiles: ClassVar[bool] = True

    def __post_init__(self) -> None:
        """Refuse a jump that cuts everything, and smoothing beyond what noise explains."""
        if self.max_jump is not None and not self.max_jump > 0:
            raise InputError(f"max_jump must be above 0, got {self.max_jump:g} m.")
        if not 0 <= self.smoothing <= 1:
            raise InputError(
                f"smoothing must lie from 0 to 1 standard deviation, got {self.smoothing:g}."
            )

    def mesh(self, cloud: PointCloud) -> Mesh:
        """Make the surface; its vertices are the points that have neighbours, in their order.

        Raises:
            InputError: The points do not say to which profile and scan line they belong.
        """
        return join_tiles([self.mesh_tile(cloud, slice(0, len(cloud)))])

    def mesh_tile(self, cloud: PointCloud, own: slice) -> Mesh:
        """Make the triangles that begin at some of the points, whole profiles of them.

        A tile needs the profiles before and behind, over which its points are evened out; what
        counts as a jump is told from what it sees.

        Args:
            cloud: Points in order of frames.
            own: Those of the tile.

        Returns:
            All of its own points, moved, and triangles between them and those that follow.

        Raises:
            InputError: The points do not say to which profile and scan line they belong.
        """
        if len(cloud) == 0:
            return empty_mesh()
        grid = ScanGrid.from_cloud(cloud, max_jump=self.max_jump)
        if not grid.is_numbered:
            raise InputError(
                f"The cloud's {len(cloud)} points do not say to which profile and scan line they "
                "belong, as those of other programs do not, so their neighbours are unknown; make "
                "the surface with --mesher poisson, or in Python Poisson()."
            )
        along, across = grid.linked(0, 1), grid.linked(1, 0)
        faces = np.concatenate([_full_cells(grid, along, across), _corners(along, across)])
        faces = _face_camera(grid, faces)
        vertices = smooth_points(grid, along, across, most=self.smoothing)
        first = faces[np.arange(len(faces)), grid.profile[faces].argmin(axis=1)]
        mine = (first >= own.start) & (first < own.stop)
        return Mesh(vertices[own], faces[mine] - own.start, points=np.arange(len(cloud))[own])

    def mesh_passes(self, passes: Sequence[PointCloud]) -> Mesh:
        """Make a sheet a pass; where sheets lie on one another, that of the first pass stays.

        Raises:
            InputError: The points do not say to which profile and scan line they belong.
        """
        starts = np.cumsum([0, *map(len, passes)]).tolist()
        sheets = [self.mesh(one) for one in passes]
        return join_sheets(
            [
                replace(sheet, points=sheet.points + start)
                for sheet, start in zip(sheets, starts, strict=False)
                if sheet.points is not None
            ]
        )


def _full_cells(grid: ScanGrid, along: Indices, across: Indices) -> Faces:
    """Make two triangles of every four points that are linked in a ring."""
    a = np.flatnonzero((along != NONE) & (across != NONE))
    b, c = along[a], across[a]
    d = along[c]
    ring = (d != NONE) & (across[b] == d)
    a, b, c, d = a[ring], b[ring], c[ring], d[ring]
    by_ad = grid.distance(a, d) <= grid.distance(b, c)
    first = np.stack([a, c, np.where(by_ad, d, b)], axis=1)
    second = np.stack([np.where(by_ad, a, c), d, b], axis=1)
    return np.concatenate([first, second])


def _corners(along: Indices, across: Indices) -> Faces:
    """Make a triangle of every three points whose fourth is missing."""
    found = []
    for beside, turned in ((along, False), (reverse_links(along), True)):
        for beyond, turned_again in ((across, False), (reverse_links(across), True)):
            a = np.flatnonzero((beside != NONE) & (beyond != NONE))
            b, c = beside[a], beyond[a]
            alone = (beyond[b] == NONE) & (beside[c] == NONE)
            corner = np.stack([a, c, b], axis=1)[alone]
            found.append(corner if turned == turned_again else corner[:, ::-1])
    return np.concatenate(found)


def _face_camera(grid: ScanGrid, faces: Faces) -> Faces:
    """Turn the triangles to the camera, each strip between two profiles as a whole.

    All cells of a strip are wound alike; which way depends on where the rig moved. The strip's
    normals vote, so that a noisy point cannot turn its own triangle.
    """
    points, normals = grid.cloud.points, grid.cloud.normals
    a, b, c = faces.T
    upright = np.cross(points[b] - points[a], points[c] - points[a])
    votes = np.einsum("ij,ij->i", upright, normals[a] + normals[b] + normals[c])
    strip = grid.profile[faces].min(axis=1)
    away = np.bincount(strip, weights=votes) < 0
    return np.where(away[strip][:, None], faces[:, ::-1], faces)
