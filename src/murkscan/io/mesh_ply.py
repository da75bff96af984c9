"""Meshes as PLY files in double precision, which trimesh does not write.

At sea numbers are large.
"""

import re
from pathlib import Path

import numpy as np

from ..errors import FormatError
from ..types.mesh import Mesh

_COLOURS = ("red", "green", "blue")
_END = re.compile(rb"^end_header[ \t]*\r?\n", re.MULTILINE)
_SPOKEN = (b"comment", b"obj_info")


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


def only_geometry(path: Path, data: bytes) -> bytes:
    """Give a PLY file without its comments, one of which may name a picture.

    Args:
        path: What errors call it.
        data: The file.

    Raises:
        FormatError: It is text, and has fewer lines than its header declares.
    """
    end = _END.search(data)
    if end is None:
        raise FormatError(f"{path} is not a PLY file that can be read.")
    lines = data[: end.start()].splitlines()
    kept = [line for line in lines if line and not line.lower().startswith(_SPOKEN)]
    body = memoryview(data)[end.end() :]
    if any(line.split()[:2] == [b"format", b"ascii"] for line in kept):
        counts = [line.split()[2] for line in kept if re.match(rb"element\s+\w+\s+\d+\s*$", line)]
        declared, there = sum(map(int, counts)), bytes(body).strip().count(b"\n") + 1
        if there < declared:
            raise FormatError(
                f"{path} declares {declared} vertices and faces but holds {there} lines; it is cut "
                "off or damaged."
            )
    return b"".join([b"\n".join([*kept, b"end_header", b""]), body])
