"""The nearest place of a surface to each point, and on which side the point lies."""

from dataclasses import dataclass

import numpy as np

from .._kernels.closest import bound_nodes, find_nearest, sort_triangles
from ..types.arrays import Directions, Faces, Indices, Mask, Points, Scalars
from ..types.mesh import Mesh
from .row_keys import row_keys

_BLOCK = 500_000
"""Points whose places are looked at together: memory stays bounded."""
_AT_RIM = 1e-6
"""Share of a triangle's height within which a place lies on one of its sides."""


@dataclass(frozen=True, eq=False)
class Closest:
    """What of a surface is nearest to each point; one a row."""

    places: Points
    """The nearest places [m]."""
    face: Indices
    """Number of the triangle each lies on; -1 where none lies within the reach."""
    distance: Scalars
    """How far away they are [m]; infinite where there is none."""
    is_at_rim: Mask
    """Whether the place is on the surface's open rim, so that the point lies beside the surface."""


def find_closest(points: Points, mesh: Mesh, *, within: float) -> Closest:
    """Find the nearest place of a surface to each point, in the same frame.

    Args:
        points: The points [m].
        mesh: The surface.
        within: Distance beyond which none is looked for [m].
    """
    if len(mesh.faces) == 0:
        nowhere = np.full((len(points), 3), np.nan)
        far = np.full(len(points), np.inf)
        return Closest(nowhere, np.full(len(points), -1), far, np.zeros(len(points), bool))
    triangles = mesh.vertices[mesh.faces]
    order = sort_triangles(triangles.mean(axis=1))
    triangles = triangles[order]
    # Rows side by side in memory, however they were cut out: each way is compiled by itself.
    rows = np.ascontiguousarray(points)
    number, weights, distance = find_nearest(rows, triangles, bound_nodes(triangles), within)
    face = np.where(number >= 0, order[number], -1)
    places = np.full((len(points), 3), np.nan)
    is_at_rim = np.zeros(len(points), bool)
    rim = _Rim.of(mesh)
    for start in range(0, len(points), _BLOCK):
        met = start + np.flatnonzero(face[start : start + _BLOCK] >= 0)
        places[met] = np.einsum("nk,nkj->nj", weights[met], triangles[number[met]])
        is_at_rim[met] = rim.holds(face[met], weights[met])
    return Closest(places, face, distance, is_at_rim)


@dataclass(frozen=True, eq=False)
class _Rim:
    """The sides that only one triangle has, and their corners."""

    sides: np.ndarray
    """Whether each side of each triangle is one."""
    corners: np.ndarray
    """Whether each corner of each triangle ends one."""

    @classmethod
    def of(cls, mesh: Mesh) -> "_Rim":
        sides = open_sides(mesh.faces)
        is_corner = np.zeros(len(mesh.vertices), bool)
        is_corner[mesh.faces[sides]] = True
        is_corner[np.roll(mesh.faces, -1, axis=1)[sides]] = True
        return cls(sides, is_corner[mesh.faces])

    def holds(self, face: Indices, weights: Points) -> Mask:
        """Tell which places, given by the weights of a triangle's corners, lie on it."""
        # Weight i falls to 0 on the side opposite to corner i, which runs from i + 1 to i + 2.
        on_side = (weights[:, [2, 0, 1]] < _AT_RIM) & self.sides[face]
        at_corner = (weights > 1 - _AT_RIM) & self.corners[face]
        return np.any(on_side | at_corner, axis=1)


def open_sides(faces: Faces) -> np.ndarray:
    """Tell which sides of each triangle no other triangle has; side i runs from corner i to i + 1.

    Sides are counted in both directions, so that a closed and a wrongly turned surface have none.
    """
    sides = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2), axis=2).reshape(-1, 2)
    _, number, count = np.unique(row_keys(sides), return_inverse=True, return_counts=True)
    return (count[number] == 1).reshape(faces.shape)


def face_normals(mesh: Mesh) -> Directions:
    """Give the unit normal of each triangle; zero for one without area."""
    a, b, c = (mesh.vertices[corner] for corner in mesh.faces.T)
    normals = np.cross(b - a, c - a)
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
