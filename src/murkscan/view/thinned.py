"""Fewer points and triangles than there are, for what a browser can hold."""

import numpy as np
from jaxtyping import Int

from ..geometry.row_keys import row_keys
from ..types.arrays import Faces, Indices, Points
from ..types.mesh import Mesh

Kept = Int[np.ndarray, "kept"]
Left = Int[np.ndarray, "left 3"]

_GROWTH = 1.25
"""Factor by which cells grow until few enough are left."""


def choose_fairly(count: int, most: int) -> Indices:
    """Choose that many of so many, each with the same chance, in their order; the same ones always.

    Args:
        count: How many there are.
        most: How many to choose, at most.
    """
    if count <= most:
        return np.arange(count)
    return np.sort(np.random.default_rng(0).choice(count, most, replace=False))


def cluster_vertices(mesh: Mesh, most: int) -> Mesh:
    """Join the vertices in each cell of a cubic grid, with cells so large that few are left.

    Args:
        mesh: The surface.
        most: Vertices to keep, at most. A mesh with no more is given back as it is.

    Returns:
        The surface; each of its vertices is one of the old ones, the first of its cell.

    References:
        Rossignac, Borrel, Multi-resolution 3D approximations for rendering complex scenes, in
        Modeling in Computer Graphics, Springer 1993.
    """
    if len(mesh.vertices) <= most:
        return mesh
    corner = mesh.vertices.min(axis=0)
    cell = _first_cell(mesh, most)
    while True:
        kept, owner = _join(mesh.vertices - corner, cell)
        if len(kept) <= most:
            points = None if mesh.points is None else mesh.points[kept]
            faces = _without_collapsed(owner[mesh.faces])
            return Mesh(mesh.vertices[kept], faces, points=points)
        cell *= _GROWTH


def _first_cell(mesh: Mesh, most: int) -> float:
    """Give the size of a cell if the surface were spread over so many squares [m]."""
    a, b, c = (mesh.vertices[corner] for corner in mesh.faces.T)
    area = float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()) / 2
    return max(float(np.sqrt(area / most)), 1e-9)


def _join(points: Points, cell: float) -> tuple[Kept, Indices]:
    steps = np.floor(points / cell).astype(np.int64)
    _, first, owner = np.unique(row_keys(steps), return_index=True, return_inverse=True)
    # In their old order, which is that of the scan and packs well.
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return first[order], rank[owner]


def _without_collapsed(faces: Faces) -> Left:
    a, b, c = faces.T
    left = faces[(a != b) & (b != c) & (c != a)]
    _, first = np.unique(row_keys(np.sort(left, axis=1)), return_index=True)
    return left[np.sort(first)]
