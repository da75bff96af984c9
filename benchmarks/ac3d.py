"""AC3D models, as a mesh: what flight simulators' ships come in."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

import numpy as np

from murkscan import FormatError, Mesh

UPRIGHT = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
"""From AC3D's axes (y up) to ours on land (z up)."""


@dataclass
class Part:
    """One object of the file, in its model's frame."""

    name: str = ""
    origin: np.ndarray = field(default_factory=lambda: np.zeros(3))
    turn: np.ndarray = field(default_factory=lambda: np.eye(3))
    vertices: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))
    faces: list[list[int]] = field(default_factory=list)


def read_ac3d(path: Path, parts: Sequence[str]) -> Mesh:
    """Give the named objects as one mesh of triangles [m, z up].

    Raises:
        FormatError: The file is no AC3D model, or an object is not in it.
    """
    lines = iter(path.read_text("latin-1").splitlines())
    if not next(lines, "").startswith("AC3D"):
        raise FormatError(f"{path} is no AC3D model; its first line should begin with AC3D.")
    found = {part.name: part for part in _read_object(lines, Part())}
    missing = [name for name in parts if name not in found]
    if missing:
        raise FormatError(f"{path} has no object {missing[0]!r}; it has {', '.join(found)}.")
    vertices, faces, count = [], [], 0
    for part in (found[name] for name in parts):
        vertices.append(part.vertices @ UPRIGHT.T)
        faces.append(np.array(part.faces, np.int32).reshape(-1, 3) + count)
        count += len(part.vertices)
    return Mesh(np.concatenate(vertices), np.concatenate(faces))


def _read_object(lines: Iterator[str], parent: Part) -> Iterator[Part]:
    """Read what follows up to `kids`, place it in its parent, and go on with the children."""
    part = Part(origin=parent.origin, turn=parent.turn)
    # fans of triangles: its surfaces are convex
    for line in lines:
        key, *rest = line.split()
        if key == "name":
            part.name = line.split('"')[1]
        elif key == "rot":
            part.turn = parent.turn @ np.array(rest, float).reshape(3, 3).T
        elif key == "loc":
            part.origin = parent.origin + parent.turn @ np.array(rest, float)
        elif key == "data":
            next(lines)
        elif key == "numvert":
            rows = np.array([next(lines).split()[:3] for _ in range(int(rest[0]))], float)
            part.vertices = rows.reshape(-1, 3) @ part.turn.T + part.origin
        elif key == "refs":
            corners = [int(next(lines).split()[0]) for _ in range(int(rest[0]))]
            part.faces += [[corners[0], *pair] for pair in pairwise(corners[1:])]
        elif key == "kids":
            yield part
            for _ in range(int(rest[0])):
                yield from _read_object(lines, part)
            return
