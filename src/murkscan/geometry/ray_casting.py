"""What a straight line meets first: triangles by Embree, the meeting point in double precision."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene

from ..types.arrays import Directions, Indices, Mask, Points, Scalars
from ..types.mesh import Mesh
from ..types.rays import Rays

_SLACK = 2e-5
"""Distance [m] by which a path may miss its end: Embree counts in single precision."""
_BLOCK = 50_000
"""Triangles that are looked at together: what lies between takes 10 MB."""


@dataclass(frozen=True, eq=False)
class Hits:
    """What each ray meets first; one a row."""

    face: Indices
    """Number of the triangle; -1 where there is none."""
    range: Scalars
    """Distance along the ray to that triangle's plane [m]; infinite where there is none."""

    @property
    def is_hit(self) -> Mask:
        """Tell which rays meet anything."""
        return self.face >= 0


@dataclass(frozen=True, eq=False)
class RayCaster:
    """A mesh that rays can be cast at; in whatever frame the mesh is in."""

    mesh: Mesh

    def first_hits(self, rays: Rays) -> Hits:
        """Find what each ray meets first; a ray with NaN meets nothing."""
        if len(self.mesh.faces) == 0:
            count = len(rays.origins)
            return Hits(np.full(count, -1), np.full(count, np.inf))
        origins = np.nan_to_num(rays.origins - self._middle)
        away = np.nan_to_num(rays.directions)
        face = self._scene.run(origins.astype(np.float32), away.astype(np.float32))
        face = np.where(np.isfinite(rays.directions[:, 0]), face, -1)
        met = np.flatnonzero(face >= 0)
        distance = np.full(len(face), np.inf)
        some = Rays(rays.origins[met], rays.directions[met])
        distance[met] = self.range_to_face(some, face[met])
        return Hits(face, distance)

    def range_to_face(self, rays: Rays, face: Indices) -> Scalars:
        """Give the distance along each ray to the plane of a triangle [m], in double precision."""
        normal = self.normals[face]
        height = np.einsum("ij,ij->i", self._corners(face) - rays.origins, normal)
        with np.errstate(divide="ignore", invalid="ignore"):
            return height / np.einsum("ij,ij->i", rays.directions, normal)

    def height_above(self, points: Points, face: Indices) -> Scalars:
        """Give the signed distance of each point from the plane of a triangle [m]."""
        return np.einsum("ij,ij->i", points - self._corners(face), self.normals[face])

    def is_free(self, rays: Rays, ranges: Scalars) -> Mask:
        """Tell along which rays nothing lies before the given range [m]."""
        return self.first_hits(rays).range > ranges * (1 - 1e-5) - _SLACK

    @cached_property
    def normals(self) -> Directions:
        """Unit normal of each triangle; the zero vector for one without area."""
        normals = np.empty((len(self.mesh.faces), 3))
        for start in range(0, len(normals), _BLOCK):
            some = slice(start, start + _BLOCK)
            a, b, c = (self.mesh.vertices[corner] for corner in self.mesh.faces[some].T)
            across = np.cross(b - a, c - a)
            size = np.linalg.norm(across, axis=1, keepdims=True)
            normals[some] = across / np.maximum(size, 1e-300)
        return normals

    def _corners(self, face: Indices) -> Points:
        return self.mesh.vertices[self.mesh.faces[face, 0]]

    @cached_property
    def _middle(self) -> Points:
        """Where Embree's single precision is best spent."""
        return (self.mesh.vertices.min(axis=0) + self.mesh.vertices.max(axis=0))[None] / 2

    @cached_property
    def _scene(self) -> EmbreeScene:
        scene = EmbreeScene()
        vertices = (self.mesh.vertices - self._middle).astype(np.float32)
        TriangleMesh(scene, vertices, self.mesh.faces.astype(np.int32))
        return scene
