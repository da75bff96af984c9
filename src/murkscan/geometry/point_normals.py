"""Normals of points of which nothing is known but their places."""

from dataclasses import replace

import numpy as np
import scipy
from jaxtyping import Float, Int

from ..errors import NotEnoughData
from ..types.arrays import Directions, Mask, Normals, Points, Scalars
from ..types.cloud import PointCloud

_NEIGHBOURS = 30
"""Points around a place that make its plane: where a scanner's lines are five times as far apart as
the points on them, they lie on three lines."""
_STRIDE = 3
"""Every so many of these a normal is turned alike with: near ones and far ones."""
_BLOCK = 50_000

Near = Int[np.ndarray, "n k"]
"""Numbers of each point's neighbours, itself first."""


def estimate_point_normals(points: Points) -> Normals:
    """Fit a plane to the points around each, and turn neighbours alike.

    Which side is the front nobody knows: the point of a piece with the smallest z is taken to look
    that way, towards the camera of a scan without poses.

    Args:
        points: Points of a surface [m], in any order.

    Raises:
        NotEnoughData: There are fewer than four points.

    References:
        Hoppe et al., Surface reconstruction from unorganized points, SIGGRAPH 1992, section 3.
    """
    return _estimate(points)[0].astype(np.float32)


def complete_normals(cloud: PointCloud, unnumbered: Mask) -> PointCloud:
    """Give normals to points of other programs, in passes that bring none for half of theirs.

    Each piece of them is turned as the known normals nearest to it are.

    Args:
        cloud: Points of which some may have normals.
        unnumbered: Those that another program made; the others stay as they are.

    Raises:
        NotEnoughData: These passes have fewer than four points.
    """
    has_normal = cloud.normals.any(axis=1)
    _, which = np.unique(cloud.frame, return_inverse=True)
    total = np.bincount(which, unnumbered)
    brought = np.bincount(which, unnumbered & has_normal)
    bare = unnumbered & (brought < 0.5 * total)[which]
    if not bare.any():
        return cloud
    found, piece, reach = _estimate(cloud.points[bare])
    known = cloud[has_normal & ~bare]
    if len(known):
        away, nearest = scipy.spatial.KDTree(known.points).query(cloud.points[bare])
        dots = np.einsum("ij,ij->i", found, known.normals[nearest])
        # Within the disc that made the plane all count alike, farther away less and less.
        votes = np.bincount(piece, dots / (away**2 + reach**2 + 1e-300))
        found = found * np.where(votes < 0, -1.0, 1.0)[piece][:, None]
    normals = cloud.normals.copy()
    normals[bare] = found
    return replace(cloud, normals=normals)


def _estimate(points: Points) -> tuple[Directions, Int[np.ndarray, " n"], Scalars]:
    """Give each point's normal, its piece, and how far its neighbours are away [m]."""
    if len(points) < 4:
        raise NotEnoughData(f"Normals need at least 4 points, got {len(points)}.")
    away, near = scipy.spatial.KDTree(points).query(points, k=min(_NEIGHBOURS, len(points)))
    near = np.asarray(near)
    normals = np.concatenate(
        [_fit_planes(points[near[at : at + _BLOCK]]) for at in range(0, len(points), _BLOCK)]
    )
    sign, piece = _turn_alike(points, normals, near)
    return normals * sign[:, None], piece, np.asarray(away)[:, -1]


def _fit_planes(around: Float[np.ndarray, "m k 3"]) -> Directions:
    """Give the direction in which each group of points spreads least."""
    off = around - around.mean(axis=1, keepdims=True)
    return np.linalg.eigh(np.einsum("mki,mkj->mij", off, off))[1][:, :, 0]


def _turn_alike(
    points: Points, normals: Directions, near: Near
) -> tuple[Float[np.ndarray, " n"], Int[np.ndarray, " n"]]:
    """Give each normal's sign, along the tree on which neighbours differ least, and its piece."""
    there = near[:, 1::_STRIDE]
    here = np.repeat(np.arange(len(points)), there.shape[1])
    alike = np.abs(np.einsum("ij,ij->i", normals[here], normals[there.ravel()]))
    # An edge of weight 0 would be none.
    weights = np.maximum(1.0 - alike, 0.0) + 1e-6
    graph = scipy.sparse.csr_matrix((weights, (here, there.ravel())), shape=(len(points),) * 2)
    tree = scipy.sparse.csr_matrix(
        scipy.sparse.csgraph.minimum_spanning_tree(graph.maximum(graph.T))
    )
    count, piece = scipy.sparse.csgraph.connected_components(tree, directed=False)
    by_depth = np.argsort(points[:, 2], kind="stable")
    _, first = np.unique(piece[by_depth], return_index=True)
    assert len(first) == count
    return _follow(tree, by_depth[first], normals), piece


def _follow(
    tree: "scipy.sparse.csr_matrix", starts: Int[np.ndarray, " pieces"], normals: Directions
) -> Float[np.ndarray, " n"]:
    """Give the signs of all pieces, each from its point with the smallest z."""
    count, edges = len(normals), tree.tocoo()
    # One root above the starts of all pieces: a search for each would go through all points.
    row = np.concatenate([edges.row, np.full(len(starts), count)])
    column = np.concatenate([edges.col, starts])
    joined = scipy.sparse.csr_matrix((np.ones(len(row)), (row, column)), shape=(count + 1,) * 2)
    order, before = scipy.sparse.csgraph.breadth_first_order(joined, count, directed=False)
    sign = np.ones(count)
    sign[starts] = np.where(normals[starts, 2] > 0, -1.0, 1.0)
    later = order[1 + len(starts) :]
    dots = np.einsum("ij,ij->i", normals[later], normals[before[later]])
    turns = np.where(dots < 0, -1.0, 1.0).tolist()
    for point, parent, turn in zip(later.tolist(), before[later].tolist(), turns, strict=True):
        sign[point] = turn * sign[parent]
    return sign
