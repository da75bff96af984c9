"""Say the same surface with fewer triangles."""

from dataclasses import replace

import numpy as np
import scipy
from jaxtyping import Int

from ..errors import InputError
from ..types.arrays import FaceMask, Faces, Points
from ..types.mesh import Mesh
from .base import drop_unused_vertices

_FEWEST = 4
"""Triangles below which there is no shape."""


def decimate(mesh: Mesh, *, faces: int) -> Mesh:
    """Leave a surface about so many triangles: few where it is flat, more where it is curved.

    Its vertices lie where they serve the triangles best, not on measured points. A triangle closes
    a hole if the nearest one of before did. Colours are lost: paint it afterwards.

    Args:
        mesh: The surface; one that has no more triangles is given back as it is.
        faces: Triangles to leave.

    Raises:
        InputError: Fewer than 4 triangles are asked for.

    References:
        Garland and Heckbert, Surface simplification using quadric error metrics, SIGGRAPH 1997.
    """
    import fast_simplification

    if faces < _FEWEST:
        raise InputError(f"A surface needs at least {_FEWEST} triangles, got {faces}.")
    if len(mesh.faces) <= faces:
        return mesh
    middle = mesh.vertices.mean(axis=0)
    before = np.ascontiguousarray(mesh.vertices - middle), mesh.faces.astype(np.int32)
    places, corners, collapses = fast_simplification.simplify(
        *before, target_count=faces, return_collapses=True
    )
    corners = corners.astype(np.int64)
    # What has collapsed to a line is no triangle.
    corners = corners[(np.diff(np.sort(corners, axis=1), axis=1) > 0).all(axis=1)]
    fewer = Mesh(places + middle, corners, points=_carry_points(mesh, *before, collapses))
    return drop_unused_vertices(
        fewer if mesh.filled is None else replace(fewer, filled=_carry_marks(mesh, fewer))
    )


def _carry_points(
    mesh: Mesh, places: Points, corners: Faces, collapses: Int[np.ndarray, "edges 2"]
) -> Int[np.ndarray, " left"] | None:
    """Give each vertex the nearest of the points that have become it."""
    import fast_simplification

    if mesh.points is None:
        return None
    fewer, _, number = fast_simplification.replay_simplification(places, corners, collapses)
    order = np.lexsort((np.linalg.norm(fewer[number] - places, axis=1), number))
    _, first = np.unique(number[order], return_index=True)
    return mesh.points[order[first]]


def _carry_marks(before: Mesh, after: Mesh) -> FaceMask:
    assert before.filled is not None
    tree = scipy.spatial.KDTree(before.vertices[before.faces].mean(axis=1))
    _, nearest = tree.query(after.vertices[after.faces].mean(axis=1))
    return before.filled[nearest]
