"""Say the same surface with fewer triangles."""

import numpy as np
from scipy.spatial import KDTree

from ..errors import InputError
from ..types.arrays import FaceMask
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
    points, corners = fast_simplification.simplify(
        np.ascontiguousarray(mesh.vertices - middle),
        mesh.faces.astype(np.int32),
        target_count=faces,
    )
    corners = corners.astype(np.int64)
    # What has collapsed to a line is no triangle.
    corners = corners[(np.diff(np.sort(corners, axis=1), axis=1) > 0).all(axis=1)]
    fewer = Mesh(points + middle, corners)
    return drop_unused_vertices(
        Mesh(fewer.vertices, corners, None if mesh.filled is None else _carry_marks(mesh, fewer))
    )


def _carry_marks(before: Mesh, after: Mesh) -> FaceMask:
    assert before.filled is not None
    tree = KDTree(before.vertices[before.faces].mean(axis=1))
    _, nearest = tree.query(after.vertices[after.faces].mean(axis=1))
    return before.filled[nearest]
