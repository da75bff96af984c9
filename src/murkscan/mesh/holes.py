"""Close holes of a surface, and say where: nothing was measured there."""

from collections import defaultdict
from dataclasses import dataclass, replace

import numpy as np
import scipy
from jaxtyping import Bool, Int

from .._kernels.fill_hole import least_area
from ..errors import InputError
from ..types.arrays import Directions, Faces, Indices
from ..types.mesh import Mesh

_MOST_SIDES = 1000
"""Sides of a hole that is closed, at most: the time goes with their third power, two seconds for
these."""

Keys = Int[np.ndarray, "keys"]
"""Sides by number, the smallest first."""
SideMask = Bool[np.ndarray, "sides"]
Sides = Int[np.ndarray, "sides 2"]
"""Sides of triangles as two vertex numbers, from and to."""


@dataclass(frozen=True, eq=False)
class ClosedHoles:
    """What has become of a surface's holes."""

    mesh: Mesh
    """The surface; `filled` marks the new triangles."""
    num_closed: int
    """Holes that were closed."""
    num_left: int
    """Holes that stay open, because they are wider than allowed or cannot be closed."""


def close_holes(mesh: Mesh, *, largest: float) -> ClosedHoles:
    """Cover small holes by the least area between their corners; no vertex is added or moved.

    The outer rim of a surface is no hole, however small: a cover would fold back over the surface.

    Args:
        mesh: The surface.
        largest: Distance of a hole's two farthest corners up to which it is closed [m].

    Raises:
        InputError: largest is not above 0.
    """
    if not largest > 0:
        raise InputError(f"Holes to close must be larger than 0, got {largest:g} m.")
    sides, normals = _open_sides(mesh)
    taken, patches, num_left = _Taken(mesh), list[Faces](), 0
    for loop in _find_loops(sides):
        corners = sides[loop, 0]
        if not _is_hole(mesh, corners, normals[loop]):
            continue
        patch = _cover(mesh, corners, taken, largest)
        num_left += len(patch) == 0
        if len(patch):
            patches.append(patch)
            taken.add(patch)
    faces = np.concatenate([mesh.faces, *patches])
    before = np.zeros(len(mesh.faces), bool) if mesh.filled is None else mesh.filled
    filled = np.concatenate([before, np.ones(len(faces) - len(before), bool)])
    closed = replace(mesh, faces=faces, filled=filled)
    return ClosedHoles(closed, len(patches), num_left)


class _Taken:
    """The sides that a surface has, and those that patches have added: none may come again."""

    def __init__(self, mesh: Mesh) -> None:
        self._keys = _sorted_keys(mesh.faces)
        self._added: set[int] = set()
        self._is_touched = np.zeros(len(mesh.vertices), bool)

    def add(self, patch: Faces) -> None:
        """Count the sides of a patch, too."""
        self._added.update(_sorted_keys(patch).tolist())
        self._is_touched[patch] = True

    def has(self, sides: Sides) -> SideMask:
        """Tell which sides are there already, in either direction."""
        keys = _keys(sides)
        slot = np.minimum(np.searchsorted(self._keys, keys), len(self._keys) - 1)
        found = self._keys[slot] == keys
        both = np.flatnonzero(self._is_touched[sides].all(axis=1))
        found[both] |= np.array([key in self._added for key in keys[both].tolist()], bool)
        return found


def _open_sides(mesh: Mesh) -> tuple[Sides, Directions]:
    """Give the sides that only one triangle has, in its sense, and that triangle's unit normal."""
    sides = np.stack([mesh.faces, np.roll(mesh.faces, -1, axis=1)], axis=2).reshape(-1, 2)
    _, number, count = np.unique(_keys(sides), return_inverse=True, return_counts=True)
    is_open = count[number] == 1
    a, b, c = (mesh.vertices[corner] for corner in mesh.faces.T)
    upright = np.cross(b - a, c - a)
    upright /= np.maximum(np.linalg.norm(upright, axis=1, keepdims=True), 1e-300)
    return sides[is_open], np.repeat(upright, 3, axis=0)[is_open]


def _keys(sides: Sides) -> Keys:
    """Number the sides so that both directions of one have the same number."""
    return sides.min(axis=1).astype(np.int64) << 32 | sides.max(axis=1)


def _sorted_keys(faces: Faces) -> Keys:
    return np.sort(_keys(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])))


def _find_loops(sides: Sides) -> list[list[int]]:
    """Walk along open sides, and cut off each loop as soon as a vertex comes again."""
    onward: dict[int, list[int]] = defaultdict(list)
    starts, ends = sides[:, 0].tolist(), sides[:, 1].tolist()
    for number, start in enumerate(starts):
        onward[start].append(number)
    loops: list[list[int]] = []
    for start in dict.fromkeys(starts):
        place, path, here = {start: 0}, list[int](), start
        while onward[here]:
            path.append(onward[here].pop())
            here = ends[path[-1]]
            if here in place:
                loop = path[place[here] :]
                del path[place[here] :]
                for number in loop[1:]:
                    place.pop(starts[number])
                loops.append(loop)
            else:
                place[here] = len(path)
    return loops


def _is_hole(mesh: Mesh, corners: Indices, normals: Directions) -> bool:
    """Tell a hole from an outer rim: round it the sides run clockwise, seen from outside."""
    places = mesh.vertices[corners] - mesh.vertices[corners[0]]
    area = np.cross(places, np.roll(places, -1, axis=0)).sum(axis=0)
    return bool(area @ normals.sum(axis=0) < 0)


def _cover(mesh: Mesh, corners: Indices, taken: "_Taken", largest: float) -> Faces:
    """Give triangles over a hole, turned as those around it; none where it stays open."""
    none = np.zeros((0, 3), mesh.faces.dtype)
    if not 3 <= len(corners) <= _MOST_SIDES:
        return none
    places = mesh.vertices[corners]
    # The box is looked at first: it costs nothing, and no two corners are nearer than its side.
    apart = scipy.spatial.distance.pdist
    if np.ptp(places, axis=0).max() > largest or apart(places).max() > largest:
        return none
    first, second = np.triu_indices(len(corners), 2)
    sides = np.stack([corners[first], corners[second]], axis=1)
    is_barred = np.zeros((len(corners), len(corners)), bool)
    is_barred[first, second] = taken.has(sides)
    # The open sides run against the new triangles.
    return corners[least_area(places, is_barred)][:, ::-1].astype(mesh.faces.dtype)
