"""What a mesh shows of itself: one ray a sample, on Embree."""

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene

from ..types.arrays import Directions, Faces, Points
from ..types.mesh import Mesh
from .window import Relief, Window

_ROUNDS = 2
"""Times that a vertex takes the mean normal of its triangles' corners: what noise does to a normal
is smoothed, an edge stays within two triangles."""


def cast_mesh(mesh: Mesh, points: Points, window: Window) -> Relief:
    """Look at a mesh.

    Args:
        mesh: The surface.
        points: Its vertices in samples of the window, with their depth.
        window: The picture.

    Returns:
        What is nearest to the viewer in each sample, with normals that are smooth across triangles.
    """
    # Embree counts in single precision: offsets from the surface's own corner keep it exact.
    corner = np.floor(points.min(axis=0))
    width, height = (np.ceil(points.max(axis=0) - corner)[:2] + 1).astype(int).tolist()
    hits = _cast_rays(points - corner, mesh.faces, width, height)
    number = hits["primID"]
    seen = np.flatnonzero(number >= 0)
    number = number[seen]
    b, c = hits["u"][seen, None], hits["v"][seen, None]
    normals = vertex_normals(points, mesh.faces)[mesh.faces[number]]
    normal = (1 - b - c) * normals[:, 0] + b * normals[:, 1] + c * normals[:, 2]
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
    # Outside is where the triangle itself, not the smoothed normal, faces the viewer.
    outside = _flat_towards(points, mesh.faces)[number]
    normal *= np.where(outside, 1.0, -1.0)[:, None]
    return _place(
        window, corner, (seen // width, seen % width), hits["tfar"][seen], normal, outside
    )


def vertex_normals(points: Points, faces: Faces) -> Directions:
    """Average the triangles' normals at each vertex, weighted by area, and smooth them a little."""
    a, b, c = (points[corner] for corner in faces.T)
    normals = _gather(np.repeat(np.cross(b - a, c - a)[:, None], 3, axis=1), faces, len(points))
    for _ in range(_ROUNDS):
        mean = normals[faces].mean(axis=1)
        normals = _gather(np.repeat(mean[:, None], 3, axis=1), faces, len(points))
    return normals


def _gather(values: np.ndarray, faces: Faces, count: int) -> Directions:
    """Sum the values of all triangles' corners at each vertex, and make them unit length."""
    sums = [np.bincount(faces.ravel(), values[..., axis].ravel(), count) for axis in range(3)]
    normals = np.stack(sums, axis=1)
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)


def _cast_rays(points: Points, faces: Faces, width: int, height: int) -> dict[str, np.ndarray]:
    scene = EmbreeScene()
    TriangleMesh(scene, points.astype(np.float32), faces.astype(np.int32))
    rows, columns = np.divmod(np.arange(width * height), width)
    origins = np.stack([columns, rows, np.full(len(rows), -1.0)], axis=1).astype(np.float32)
    directions = np.zeros_like(origins)
    directions[:, 2] = 1
    return scene.run(origins, directions, output=True)


def _flat_towards(points: Points, faces: Faces) -> np.ndarray:
    a, b, c = (points[corner, :2] for corner in faces.T)
    (bu, bv), (cu, cv) = (b - a).T, (c - a).T
    return bu * cv - bv * cu < 0


def _place(
    window: Window,
    corner: np.ndarray,
    at: tuple[np.ndarray, np.ndarray],
    depth: np.ndarray,
    normal: Directions,
    outside: np.ndarray,
) -> Relief:
    width, height = window.num_samples
    rows, columns = at[0] + int(corner[1]), at[1] + int(corner[0])
    relief = Relief(
        np.full((height, width), np.nan),
        np.zeros((height, width, 3)),
        np.zeros((height, width), bool),
    )
    relief.depth[rows, columns] = depth - 1 + corner[2]
    relief.normals[rows, columns] = normal
    relief.outside[rows, columns] = outside
    return relief
