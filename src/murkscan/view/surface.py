"""What a mesh shows of itself."""

import numpy as np

from .._kernels.rasterise import cover_with_triangles, sum_at_corners, turn_to_viewer
from ..types.arrays import Directions, Faces, Points
from ..types.mesh import Mesh
from .window import Relief, Window

_ROUNDS = 2
"""Times that a vertex takes the mean normal of its triangles' corners: what noise does to a normal
is smoothed, an edge stays within two triangles."""


def look_at_mesh(mesh: Mesh, points: Points, normals: Directions, window: Window) -> Relief:
    """Look at a mesh.

    Args:
        mesh: The surface.
        points: Its vertices in samples of the window, with their depth.
        normals: The vertices' unit normals in the view frame.
        window: The picture.

    Returns:
        What is nearest to the viewer in each sample, with normals that are smooth across triangles.
    """
    depth, owner, start = window.empty_buffers(points)
    near = points - [0.0, 0.0, start]
    cover_with_triangles(near, mesh.faces, depth, owner)
    seen = np.argwhere(np.isfinite(depth))
    shown, outside = np.empty((len(seen), 3), np.float32), np.empty(len(seen), bool)
    turn_to_viewer(near, mesh.faces, normals, seen, owner[*seen.T], shown, outside)
    return Relief(depth, start, seen, shown, outside)


def vertex_normals(points: Points, faces: Faces) -> Directions:
    """Average the triangles' normals at each vertex, weighted by area, and smooth them a little."""
    a, b, c = (points[corner] for corner in faces.T)
    normals = _gather(np.cross(b - a, c - a), faces, len(points))
    for _ in range(_ROUNDS):
        normals = _gather(sum(normals[corner] for corner in faces.T) / 3, faces, len(points))
    return normals


def _gather(values: np.ndarray, faces: Faces, count: int) -> Directions:
    """Sum the triangles' vectors at each vertex, and make them unit length."""
    sums = np.zeros((count, 3))
    sum_at_corners(faces, values, sums)
    return sums / np.maximum(np.linalg.norm(sums, axis=1, keepdims=True), 1e-30)
