"""Where the numbers of a mesh file in single precision begin, in a world wider than they are.

A float of 24 bits tells places 5 000 km from the equator half a metre apart. STL and GLB therefore
count from a place of their own near the surface, and say which.
"""

import json
import re

import numpy as np

from ..types.arrays import Points, Vector

NEAR = 128.0
"""Largest coordinate that needs no origin [m]: single precision rounds it by 3.8 µm at most."""
SINGLE = (".stl", ".glb")
"""Formats of single precision."""

_STL_HEADER = 80
"""Bytes of text before the number of triangles."""
_STATED = re.compile(rb"origin (\S+) (\S+) (\S+) m")


def choose_origin(vertices: Points) -> Vector:
    """Choose where a file's coordinates count from [m]: 0, or a whole metre amid far vertices."""
    if np.abs(vertices).max(initial=0.0) <= NEAR:
        return np.zeros(3)
    return np.round((vertices.min(axis=0) + vertices.max(axis=0)) / 2) + 0.0  # no negative zero


def state_in_stl(data: bytes, origin: Vector) -> bytes:
    """Write the origin into the header of a binary STL, which says `origin X Y Z m`."""
    place = f", origin {_as_text(origin)} m" if origin.any() else ""
    header = f"murkscan: metres{place}".encode("ascii")
    return header.ljust(_STL_HEADER, b" ") + data[_STL_HEADER:]


def find_in_stl(data: bytes) -> Vector:
    """Read the origin that an STL states in its header; 0 where it states none."""
    head = data[:_STL_HEADER]
    found = _STATED.search(head) if head.startswith(b"murkscan: metres") else None
    return np.zeros(3) if found is None else _as_place(found.groups())


def state_in_glb(data: bytes, origin: Vector) -> bytes:
    """Write the origin into a GLB: `asset.extras.origin_m`, along the world's x, y and z."""
    if not origin.any():
        return data
    end = 20 + int.from_bytes(data[12:16], "little")
    tables = json.loads(data[20:end])
    tables["asset"]["extras"] = {"origin_m": origin.tolist()}
    text = json.dumps(tables).encode()
    text += b" " * (-len(text) % 4)
    chunk = len(text).to_bytes(4, "little") + b"JSON" + text + data[end:]
    return data[:8] + (12 + len(chunk)).to_bytes(4, "little") + chunk


def find_in_glb(data: bytes) -> Vector:
    """Read the origin that a GLB states; 0 where it states none, or is no GLB."""
    try:
        tables = json.loads(data[20 : 20 + int.from_bytes(data[12:16], "little")])
        return _as_place(tables["asset"]["extras"]["origin_m"])
    except (ValueError, KeyError, TypeError, RecursionError):
        return np.zeros(3)


def _as_text(origin: Vector) -> str:
    return " ".join(f"{x:.0f}" for x in origin)


def _as_place(numbers: object) -> Vector:
    try:
        place = np.array([float(x) for x in numbers])  # type: ignore[attr-defined]
    except (ValueError, TypeError):
        return np.zeros(3)
    return place if place.shape == (3,) and np.isfinite(place).all() else np.zeros(3)
