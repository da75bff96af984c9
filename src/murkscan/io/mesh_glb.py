"""What may be asked of a GLB file before a library reads it: its tables may claim anything."""

import json
from collections import Counter
from pathlib import Path
from typing import Any

from ..errors import FormatError

_HEADER = 20
"""Bytes up to the first chunk's content."""
_ALLOWED = 5_000_000
"""Items that a file of any size may place, since one part may stand in many places."""
_PARTS = 10_000
"""Parts, of which each takes about a millisecond, whatever its size."""
_PACKED = ("KHR_draco_mesh_compression", "EXT_meshopt_compression")
_NODE = ("children", "mesh", "matrix", "translation", "rotation", "scale")


def only_geometry(path: Path, data: bytes) -> bytes:
    """Give a GLB file without all that is no triangle: materials, pictures, animations, extensions.

    Args:
        path: What errors call it.
        data: The file.

    Raises:
        FormatError: It is no GLB file; or its tables claim more items, or place them more often,
            than a file of this size can mean.
    """
    try:
        end = _HEADER + int.from_bytes(data[12:16], "little")
        tables = _strip(path, json.loads(data[_HEADER:end]))
        _check_claims(path, tables, max(len(data), _ALLOWED))
    except FormatError:
        raise
    # Tables may be of any shape, and fail in any way.
    except Exception as error:
        raise FormatError(f"{path} is not a GLB file that can be read.") from error
    text = json.dumps(tables).encode()
    text += b" " * (-len(text) % 4)
    chunk = len(text).to_bytes(4, "little") + b"JSON" + text + data[end:]
    return data[:8] + (12 + len(chunk)).to_bytes(4, "little") + chunk


def _strip(path: Path, tables: dict[str, Any]) -> dict[str, Any]:
    """Keep what places triangles, and of the accessors those that they are made of."""
    packed = [name for name in _PACKED if name in tables.get("extensionsUsed", [])]
    if packed:
        raise FormatError(f"{path} is packed by {packed[0]}; save it without compression.")
    if any("uri" in buffer for buffer in tables.get("buffers", [])):
        raise FormatError(f"{path} keeps its numbers in another file; save it as one GLB file.")
    kept = {name: tables[name] for name in ("asset", "bufferViews", "buffers")}
    kept["scene"] = int(tables.get("scene", 0))
    kept["scenes"] = [{"nodes": scene.get("nodes", [])} for scene in tables["scenes"]]
    kept["nodes"] = [{key: node[key] for key in _NODE if key in node} for node in tables["nodes"]]
    accessors: list[dict[str, Any]] = []
    kept["meshes"] = [
        {"primitives": [_strip_primitive(one, tables, accessors) for one in mesh["primitives"]]}
        for mesh in tables["meshes"]
    ]
    return kept | {"accessors": accessors}


def _strip_primitive(
    primitive: dict[str, Any], tables: dict[str, Any], accessors: list[dict[str, Any]]
) -> dict[str, Any]:
    """Keep positions, colours and corners; move what describes them to a list of its own."""

    def move(number: int) -> int:
        accessor = tables["accessors"][number]
        accessors.append({key: accessor[key] for key in accessor if key not in ("min", "max")})
        return len(accessors) - 1

    attributes = primitive["attributes"]
    wanted = [name for name in ("POSITION", "COLOR_0") if name in attributes]
    kept: dict[str, Any] = {"attributes": {name: move(attributes[name]) for name in wanted}}
    if "indices" in primitive:
        kept["indices"] = move(primitive["indices"])
    return kept | {"mode": int(primitive.get("mode", 4))}


def _check_claims(path: Path, tables: dict[str, Any], most: int) -> None:
    counts = [int(accessor["count"]) for accessor in tables["accessors"]]
    sizes = [int(view["byteLength"]) for view in tables["bufferViews"]]
    parents = Counter(child for node in tables["nodes"] for child in node.get("children", []))
    # trimesh reads the one scene that is named; its roots are nobody's children.
    roots = tables["scenes"][tables["scene"]]["nodes"]
    parents.update(roots)
    if max(parents.values(), default=0) > 1:
        raise FormatError(f"{path} has nodes with several parents; it is damaged.")
    of_mesh = [
        sum(counts[one["attributes"]["POSITION"]] + counts[one.get("indices", 0)]
            for one in mesh["primitives"])
        for mesh in tables["meshes"]
    ]  # fmt: skip
    meshes = [node["mesh"] for node in tables["nodes"] if "mesh" in node]
    parts = sum(len(tables["meshes"][mesh]["primitives"]) for mesh in meshes)
    if parts > _PARTS:
        raise FormatError(
            f"{path} is made of {parts:,} parts, of which no more than {_PARTS:,} are read; join "
            "them to fewer."
        )
    placed = sum(of_mesh[mesh] for mesh in meshes)
    claimed = max(sum(counts), sum(sizes), placed)
    if claimed > most or min([*counts, *sizes], default=0) < 0:
        raise FormatError(f"{path} claims {claimed} items, for which it is too small.")
    if any("bufferView" not in accessor for accessor in tables["accessors"]):
        raise FormatError(f"{path} has items that stand nowhere; it is damaged or compressed.")
