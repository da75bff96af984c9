"""The nearest place of a surface to each point, and on which side the point lies."""

from dataclasses import dataclass

import numpy as np
import trimesh
from jaxtyping import Float, Int
from scipy.spatial import KDTree

from ..types.arrays import Directions, Faces, Indices, Mask, Points, Scalars
from ..types.mesh import Mesh

_FIRST = 8
"""Triangles nearest by their middle that are tried at first."""
_PAIRS = 500_000
"""Pairs of a point and a triangle that are measured at once: memory stays bounded."""
_AT_RIM = 1e-6
"""Share of a triangle's height within which a place lies on one of its sides."""

Numbers = Int[np.ndarray, " some"]
"""Numbers of some of the items."""


@dataclass(frozen=True, eq=False)
class Closest:
    """What of a surface is nearest to each point; one a row."""

    places: Points
    """The nearest places [m]."""
    face: Indices
    """Number of the triangle each lies on; -1 where none lies within the reach."""
    distance: Scalars
    """How far away they are [m]; infinite where there is none."""
    is_at_rim: Mask
    """Whether the place is on the surface's open rim, so that the point lies beside the surface."""


def find_closest(points: Points, mesh: Mesh, *, within: float) -> Closest:
    """Find the nearest place of a surface to each point, in the same frame.

    Args:
        points: The points [m].
        mesh: The surface.
        within: Distance beyond which none is looked for [m].
    """
    triangles = mesh.vertices[mesh.faces]
    middles = triangles.mean(axis=1)
    radii = np.linalg.norm(triangles - middles[:, None], axis=2).max(axis=1)
    sizes = np.floor(np.log2(np.maximum(radii, 1e-12))).astype(int)
    found = Closest(
        np.full((len(points), 3), np.nan),
        np.full(len(points), -1),
        np.full(len(points), within),
        np.zeros(len(points), bool),
    )
    for size in np.unique(sizes):
        some = np.flatnonzero(sizes == size)
        _approach(found, points, triangles, some, middles[some], float(radii[some].max()))
    met = np.flatnonzero(found.face >= 0)
    found.distance[found.face < 0] = np.inf
    found.is_at_rim[met] = _is_at_rim(mesh, found.face[met], found.places[met])
    return found


def _approach(
    found: Closest,
    points: Points,
    triangles: np.ndarray,
    some: Numbers,
    middles: Float[np.ndarray, "some 3"],
    reach: float,
) -> None:
    """Take the places of some triangles, of about one size, where they are nearer."""
    tree = KDTree(middles)
    left, count = np.arange(len(points)), min(_FIRST, len(middles))
    while len(left):
        found_at = tree.query(points[left], k=np.arange(1, count + 1))
        away, which = np.asarray(found_at[0]), np.asarray(found_at[1])
        near = away[:, 0] < found.distance[left] + reach
        left, away, which = left[near], away[near], which[near]
        step = max(_PAIRS // count, 1)
        for start in range(0, len(left), step):
            block = slice(start, start + step)
            _take_nearer(found, points, triangles, left[block], some[which[block]], reach)
        more = (away[:, -1] < found.distance[left] + reach) & (count < len(middles))
        left, count = left[more], min(4 * count, len(middles))


def _take_nearer(
    found: Closest,
    points: Points,
    triangles: np.ndarray,
    asking: Numbers,
    candidates: np.ndarray,
    reach: float,
) -> None:
    if not len(asking):
        return
    # trimesh compares products of lengths with fixed numbers: triangles must be of size 1.
    scale = max(reach, 1e-9)
    repeated = np.repeat(points[asking], candidates.shape[1], axis=0) / scale
    places = trimesh.triangles.closest_point(triangles[candidates.ravel()] / scale, repeated)
    away = scale * np.linalg.norm(places - repeated, axis=1).reshape(candidates.shape)
    best = away.argmin(axis=1)
    row = np.arange(len(asking))
    closer = away[row, best] < found.distance[asking]
    mine = asking[closer]
    found.distance[mine] = away[row, best][closer]
    found.face[mine] = candidates[row, best][closer]
    found.places[mine] = scale * places.reshape(*candidates.shape, 3)[row, best][closer]


def _is_at_rim(mesh: Mesh, face: Indices, places: Points) -> Mask:
    """Tell which places lie on a side that only one triangle has."""
    is_open = open_sides(mesh.faces)[face]
    corners = mesh.vertices[mesh.faces[face]]
    weights = trimesh.triangles.points_to_barycentric(corners, places)
    # Weight i falls to 0 on the side opposite to corner i, which runs from i + 1 to i + 2.
    on_side = np.abs(weights[:, [2, 0, 1]]) < _AT_RIM
    return np.any(on_side & is_open, axis=1)


def open_sides(faces: Faces) -> np.ndarray:
    """Tell which sides of each triangle no other triangle has; side i runs from corner i to i + 1.

    Sides are counted in both directions, so that a closed and a wrongly turned surface have none.
    """
    sides = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2), axis=2).reshape(-1, 2)
    _, number, count = np.unique(sides, axis=0, return_inverse=True, return_counts=True)
    return (count[number] == 1).reshape(faces.shape)


def face_normals(mesh: Mesh) -> Directions:
    """Give the unit normal of each triangle; zero for one without area."""
    a, b, c = (mesh.vertices[corner] for corner in mesh.faces.T)
    normals = np.cross(b - a, c - a)
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
