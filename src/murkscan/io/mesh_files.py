"""Meshes as PLY, STL, OBJ and GLB files, by trimesh."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import FormatError, InputError
from ..types.arrays import Colours, FaceMask, Faces, Vector
from ..types.cloud import FARTHEST
from ..types.mesh import Mesh
from . import mesh_glb, mesh_obj, mesh_ply
from .atomic import replacing
from .mesh_origin import (
    SINGLE,
    choose_origin,
    find_in_glb,
    find_in_stl,
    state_in_glb,
    state_in_stl,
)

if TYPE_CHECKING:
    import trimesh

_SUFFIXES = (".ply", ".stl", ".obj", ".glb")
_GLB_FROM_OURS = np.array([1.0, -1.0, -1.0])
"""x stays right; our y is down and z away from the viewer, those of GLB are up and towards him."""


def save_mesh(path: Path, mesh: Mesh) -> None:
    """Write a mesh in the format that the path's suffix names.

    PLY, STL and OBJ keep our axes and metres (STL and OBJ know no unit). GLB is in metres with y up
    and z towards the viewer by its standard, so its y and z are ours negated: half a turn about x,
    after which a viewer shows the front of the object upright, as the camera saw it. Colours are
    written to all but STL, the mark of triangles that close a hole to PLY only. Where vertices lie
    far from 0, STL and GLB count from an origin near them (`file_origin`), which they state.

    Args:
        path: Where the file shall be: .ply or .obj (vertices in double precision), .stl or .glb
            (single).
        mesh: The surface [m].

    Raises:
        InputError: Another suffix, or a mesh without triangles.
        DeviceError: The disk is full or cannot be written.
    """
    kind = _kind(path)
    if len(mesh.faces) == 0:
        raise InputError(f"The mesh for {path} has no triangles; nothing is written.")
    with replacing(path) as aside:
        aside.write_bytes(_WRITERS[kind](mesh))


def file_origin(path: Path, mesh: Mesh) -> Vector:
    """Tell where the coordinates count from that `save_mesh` writes [m]; 0 in double precision."""
    return choose_origin(mesh.vertices) if path.suffix.lower() in SINGLE else np.zeros(3)


def load_mesh(path: Path) -> Mesh:
    """Read a mesh in the format that the path's suffix names, in our axes.

    A GLB is turned back. An origin that the file states is added. The corners that an STL repeats
    for every triangle are joined. Of an OBJ and a GLB only the triangles are read, never their
    materials.

    Raises:
        InputError: Another suffix than .ply, .stl, .obj or .glb.
        FormatError: The file is no such mesh, or is damaged; one whose tables claim more than it
            holds costs no memory.
        FileNotFoundError: There is no such file.
    """
    import trimesh

    kind = _kind(path)
    data = path.read_bytes()
    origin = _ORIGINS[kind](data) if kind in _ORIGINS else np.zeros(3)
    if kind in _STRIPPED:
        data = _STRIPPED[kind](path, data)
    try:
        loaded = trimesh.load_mesh(trimesh.util.wrap_as_stream(data), kind, process=kind == "stl")
        vertices, faces = np.asarray(loaded.vertices, float), np.asarray(loaded.faces, np.int64)
        colours, filled = _find_colours(loaded, kind), _find_filled(loaded, len(faces))
    # Which error a damaged file ends in is up to trimesh's readers: any.
    except Exception as error:
        raise FormatError(f"{path} is not {_NAMES[kind]} file that can be read.") from error
    is_placed = vertices.shape[1:] == (3,) and bool((np.abs(vertices) < FARTHEST).all())
    if len(faces) == 0 or not is_placed or not _is_inside(faces, len(vertices)):
        raise FormatError(f"{path} has no triangles, or some without a place; it is damaged.")
    vertices = vertices * _GLB_FROM_OURS if kind == "glb" else vertices
    return Mesh(vertices + origin, faces, filled, colours)


def check_mesh_suffix(path: Path) -> None:
    """Refuse a file whose suffix names no mesh format.

    Raises:
        InputError: The suffix is another than .ply, .stl, .obj or .glb.
    """
    _kind(path)


def _is_inside(faces: Faces, count: int) -> bool:
    return bool(faces.min() >= 0 and faces.max() < count)


def _kind(path: Path) -> str:
    if path.suffix.lower() not in _SUFFIXES:
        raise InputError(f"{path} is no mesh format; take one of {', '.join(_SUFFIXES)}.")
    return path.suffix.lower()[1:]


def _as_stl(mesh: Mesh) -> bytes:
    import trimesh

    origin = choose_origin(mesh.vertices)
    made = trimesh.Trimesh(mesh.vertices - origin, mesh.faces, process=False, validate=False)
    return state_in_stl(made.export(file_type="stl"), origin)


def _as_glb(mesh: Mesh) -> bytes:
    import trimesh

    colours = None if mesh.colours is None else _as_light(mesh.colours)
    origin = choose_origin(mesh.vertices)
    made = trimesh.Trimesh(
        (mesh.vertices - origin) * _GLB_FROM_OURS,
        mesh.faces,
        vertex_colors=colours,
        process=False,
        validate=False,
    )
    return state_in_glb(made.export(file_type="glb"), origin)


def _as_light(colours: Colours) -> Colours:
    """Give colours as GLB has them: in proportion to light, where ours are as a screen takes them.

    References:
        IEC 61966-2-1, sRGB; glTF 2.0, section 3.7.2.1: COLOR_0 is linear.
    """
    share = np.arange(256) / 255
    light = np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
    return np.rint(255 * light).astype(np.uint8)[colours]


def _from_light(colours: Colours) -> Colours:
    light = np.arange(256) / 255
    share = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    return np.rint(255 * share).astype(np.uint8)[colours]


def _find_colours(loaded: "trimesh.Trimesh", kind: str) -> Colours | None:
    """Give the vertices' colours, where the file has them."""
    if loaded.visual.kind != "vertex":
        return None
    colours = np.array(loaded.visual.vertex_colors[:, :3], np.uint8)
    return _from_light(colours) if kind == "glb" else colours


def _find_filled(loaded: "trimesh.Trimesh", count: int) -> FaceMask | None:
    """Give which triangles close a hole, where a PLY says so."""
    content = loaded.metadata.get("_ply_raw", {}).get("face", {}).get("data")
    names: Any = content if isinstance(content, dict) else getattr(content, "dtype", None)
    names = names.names or () if isinstance(names, np.dtype) else names or ()
    if "filled" not in names:
        return None
    filled = np.asarray(content["filled"]).reshape(-1) != 0
    return filled if len(filled) == count else None


_STRIPPED = {
    "ply": mesh_ply.only_geometry,
    "obj": mesh_obj.only_geometry,
    "glb": mesh_glb.only_geometry,
}
_ORIGINS = {"stl": find_in_stl, "glb": find_in_glb}
_WRITERS = {"ply": mesh_ply.as_ply, "stl": _as_stl, "obj": mesh_obj.as_obj, "glb": _as_glb}
_NAMES = {"ply": "a PLY", "stl": "an STL", "obj": "an OBJ", "glb": "a GLB"}
