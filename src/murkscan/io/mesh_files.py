"""Meshes as PLY, STL and GLB files, by trimesh."""

import json
from pathlib import Path

import numpy as np
import trimesh

from ..errors import FormatError, InputError
from ..types.arrays import Faces
from ..types.mesh import Mesh
from .atomic import replacing

_SUFFIXES = (".ply", ".stl", ".glb")
_GLB_FROM_OURS = np.array([1.0, -1.0, -1.0])
"""x stays right; our y is down and z away from the viewer, those of GLB are up and towards him."""


def save_mesh(path: Path, mesh: Mesh) -> None:
    """Write a mesh in the format that the path's suffix names.

    PLY and STL keep our axes and metres (STL knows no unit). GLB is in metres with y up and z
    towards the viewer by its standard, so its y and z are ours negated: half a turn about x, after
    which a viewer shows the front of the object upright, as the camera saw it.

    Args:
        path: Where the file shall be: .ply (vertices in double precision), .stl or .glb (single).
        mesh: The surface [m].

    Raises:
        InputError: Another suffix, or a mesh without triangles.
        DeviceError: The disk is full or cannot be written.
    """
    kind = _kind(path)
    if len(mesh.faces) == 0:
        raise InputError(f"The mesh for {path} has no triangles; nothing is written.")
    if kind == "ply":
        data = _as_ply(mesh)
    else:
        vertices = mesh.vertices * _GLB_FROM_OURS if kind == "glb" else mesh.vertices
        made = trimesh.Trimesh(vertices, mesh.faces, process=False, validate=False)
        data = made.export(file_type=kind)
    with replacing(path) as aside:
        aside.write_bytes(data)


def load_mesh(path: Path) -> Mesh:
    """Read a mesh in the format that the path's suffix names, in our axes.

    A GLB is turned back. The corners that an STL repeats for every triangle are joined.

    Raises:
        InputError: Another suffix than .ply, .stl or .glb.
        FormatError: The file is no such mesh, or is damaged.
        FileNotFoundError: There is no such file.
    """
    kind = _kind(path)
    data = path.read_bytes()
    if kind == "glb":
        _check_glb(path, data)
    try:
        loaded = trimesh.load_mesh(trimesh.util.wrap_as_stream(data), kind, process=kind == "stl")
        vertices, faces = np.asarray(loaded.vertices), np.asarray(loaded.faces)
    # Which error a damaged file ends in is up to trimesh's readers: any.
    except Exception as error:
        raise FormatError(f"{path} is not a {kind.upper()} file that can be read.") from error
    if len(faces) == 0 or not np.isfinite(vertices).all() or not _is_inside(faces, len(vertices)):
        raise FormatError(f"{path} has no triangles, or some without a place; it is damaged.")
    return Mesh(vertices * _GLB_FROM_OURS if kind == "glb" else vertices, faces)


def _is_inside(faces: Faces, count: int) -> bool:
    return bool(faces.min() >= 0 and faces.max() < count)


def _check_glb(path: Path, data: bytes) -> None:
    """Refuse a GLB whose tables claim more items than the file has bytes, before they are made."""
    try:
        length = int.from_bytes(data[12:16], "little")
        tables = json.loads(data[20 : 20 + length])
        counts = [int(table["count"]) for table in tables.get("accessors", [])]
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise FormatError(f"{path} is not a GLB file that can be read.") from error
    if any(count > len(data) for count in counts):
        raise FormatError(f"{path} claims {max(counts)} items in {len(data)} bytes; it is damaged.")


def _kind(path: Path) -> str:
    if path.suffix.lower() not in _SUFFIXES:
        raise InputError(f"{path} is no mesh format; take one of {', '.join(_SUFFIXES)}.")
    return path.suffix.lower()[1:]


def _as_ply(mesh: Mesh) -> bytes:
    """Write vertices in double precision, which trimesh does not; at sea numbers are large."""
    faces = np.empty(len(mesh.faces), [("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, mesh.faces
    header = (
        "ply\nformat binary_little_endian 1.0\ncomment murkscan: metres\n"
        f"element vertex {len(mesh.vertices)}\n"
        "property double x\nproperty double y\nproperty double z\n"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    return header.encode("ascii") + mesh.vertices.astype("<f8").tobytes() + faces.tobytes()
