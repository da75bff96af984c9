"""One surface of the sheets of several passes over it."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..geometry.overlap import lies_on
from ..types.arrays import SmallNumbers
from ..types.mesh import Mesh
from .base import drop_unused_vertices, empty_mesh


def join_sheets(sheets: Sequence[Mesh]) -> Mesh:
    """Keep of each sheet what lies on none of those before it, so that nothing is there twice.

    Where two meet, neither is moved: the seam is open, and jagged by half a triangle.

    Args:
        sheets: Surfaces in one frame, turned to the same side; the first stays as it is. Their
            vertices know their points. Colours and filled holes are not looked at.
    """
    joined = empty_mesh()
    for sheet in sheets:
        kept = sheet
        if len(joined.faces) and len(sheet.faces):
            kept = drop_unused_vertices(replace(sheet, faces=sheet.faces[~lies_on(sheet, joined)]))
        joined = lay_together([joined, kept])
    return joined


def split_by_laser(mesh: Mesh, laser: SmallNumbers) -> list[Mesh]:
    """Part a surface into the sheets of its lasers, between which there are no triangles.

    Args:
        mesh: The surface; its vertices know their points.
        laser: Number of the laser that lit each of the points.
    """
    assert mesh.points is not None
    own = laser[mesh.points[mesh.faces[:, 0]]]
    return [
        drop_unused_vertices(replace(mesh, faces=mesh.faces[own == number]))
        for number in np.unique(own)
    ]


def lay_together(meshes: Sequence[Mesh]) -> Mesh:
    """Make one surface of several, of whose vertices all know their points."""
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)]).tolist()
    faces = [mesh.faces + start for mesh, start in zip(meshes, starts, strict=False)]
    points = [mesh.points for mesh in meshes if mesh.points is not None]
    vertices = [mesh.vertices for mesh in meshes]
    return Mesh(np.concatenate(vertices), np.concatenate(faces), points=np.concatenate(points))
