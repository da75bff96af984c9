"""Meshes as PLY files in double precision, which trimesh does not write.

At sea numbers are large.
"""

import numpy as np

from ..types.mesh import Mesh

_COLOURS = ("red", "green", "blue")


def as_ply(mesh: Mesh) -> bytes:
    """Give a binary PLY file; `filled` marks triangles that close a hole."""
    corners = [(name, "<f8") for name in "xyz"]
    colours = np.zeros((0, 0)) if mesh.colours is None else mesh.colours
    corners += [(name, "u1") for name in _COLOURS[: colours.shape[1]]]
    vertices = np.empty(len(mesh.vertices), corners)
    for axis, name in enumerate("xyz"):
        vertices[name] = mesh.vertices[:, axis]
    for name, column in zip(_COLOURS, colours.T, strict=False):
        vertices[name] = column
    marks = [] if mesh.filled is None else [("filled", "u1")]
    faces = np.empty(len(mesh.faces), [("count", "u1"), ("corners", "<i4", 3), *marks])
    faces["count"], faces["corners"] = 3, mesh.faces
    if mesh.filled is not None:
        faces["filled"] = mesh.filled
    types = {"<f8": "double", "u1": "uchar"}
    header = [
        "ply",
        "format binary_little_endian 1.0",
        "comment murkscan: metres",
        f"element vertex {len(vertices)}",
        *(f"property {types[kind]} {name}" for name, kind in corners),
        f"element face {len(faces)}",
        "property list uchar int vertex_indices",
        *(f"property {types[kind]} {name}" for name, kind in marks),
        "end_header\n",
    ]
    return "\n".join(header).encode("ascii") + vertices.tobytes() + faces.tobytes()
