"""The part of a surface that lies in a box."""

import numpy as np

from ..types.arrays import Vector
from ..types.mesh import Mesh


def clip_mesh(mesh: Mesh, low: Vector, high: Vector) -> Mesh:
    """Cut a surface off at the sides of a box along the axes; triangles are cut where they cross.

    Args:
        mesh: The surface.
        low: The corner of the box with the smallest coordinates [m].
        high: The one with the largest.

    Returns:
        Positions and triangles alone; none where nothing of the surface lies in the box.
    """
    from trimesh.intersections import slice_faces_plane

    corners = mesh.vertices[mesh.faces]
    near = (corners.min(axis=1) <= high) & (corners.max(axis=1) >= low)
    vertices, faces = mesh.vertices, mesh.faces[near.all(axis=1)]
    for side, corner in ((1.0, low), (-1.0, high)):
        for inwards in side * np.eye(3):
            if len(faces):
                vertices, faces, _ = slice_faces_plane(vertices, faces, inwards, corner)
    return Mesh(np.asarray(vertices), faces).compact()
