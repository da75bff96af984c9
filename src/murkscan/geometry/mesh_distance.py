"""How far points lie from a surface."""

import math

import numpy as np
import trimesh
from jaxtyping import Float
from scipy.spatial import KDTree

from ..types.arrays import Points, Scalars
from ..types.mesh import Mesh

_FIRST = 8
"""Triangles nearest by their middle that are tried at first."""
_PAIRS = 500_000
"""Pairs of a point and a triangle that are measured at once: memory stays bounded."""

Triangles = Float[np.ndarray, "m 3 3"]


def distance_to_mesh(points: Points, mesh: Mesh, *, within: float = math.inf) -> Scalars:
    """Give the distance of each point to the nearest place of a surface [m], in the same frame.

    Triangles are taken by size, each twice as large as the last: no triangle is nearer than its
    middle by more than its radius, so that few of about one size have to be measured.

    Args:
        points: The points [m].
        mesh: The surface.
        within: Distance beyond which none is looked for [m]: it is given as infinite.
    """
    triangles = mesh.vertices[mesh.faces]
    middles = triangles.mean(axis=1)
    radii = np.linalg.norm(triangles - middles[:, None], axis=2).max(axis=1)
    sizes = np.floor(np.log2(np.maximum(radii, 1e-12))).astype(int)
    distances = np.full(len(points), within)
    for size in np.unique(sizes):
        some = sizes == size
        _approach(distances, points, triangles[some], middles[some], float(radii[some].max()))
    return np.where(distances < within, distances, np.inf)


def _approach(
    distances: Scalars, points: Points, triangles: Triangles, middles: np.ndarray, reach: float
) -> None:
    """Lower the distances to those of triangles of about one size."""
    tree = KDTree(middles)
    left, count = np.arange(len(points)), min(_FIRST, len(middles))
    while len(left):
        found_at = tree.query(points[left], k=np.arange(1, count + 1))
        away, which = np.asarray(found_at[0]), np.asarray(found_at[1])
        near = away[:, 0] < distances[left] + reach
        left, away, which = left[near], away[near], which[near]
        if not len(left):
            return
        # trimesh compares products of lengths with fixed numbers: triangles must be of size 1.
        scale = max(reach, 1e-9)
        found = scale * _to_some(points[left] / scale, triangles / scale, which)
        distances[left] = np.minimum(distances[left], found)
        more = (away[:, -1] < distances[left] + reach) & (count < len(middles))
        left, count = left[more], min(4 * count, len(middles))


def _to_some(points: Points, triangles: Triangles, which: np.ndarray) -> Scalars:
    """Give the distance of each point to the nearest of its own candidates."""
    parts = []
    step = max(_PAIRS // which.shape[1], 1)
    for start in range(0, len(points), step):
        mine = which[start : start + step]
        repeated = np.repeat(points[start : start + step], mine.shape[1], axis=0)
        nearest = trimesh.triangles.closest_point(triangles[mine.ravel()], repeated)
        parts.append(np.linalg.norm(nearest - repeated, axis=1).reshape(mine.shape).min(axis=1))
    return np.concatenate(parts)
