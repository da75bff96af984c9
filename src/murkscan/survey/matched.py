"""On which passes a pass was laid."""

import numpy as np
from scipy.spatial import KDTree

from ..types.arrays import Indices
from ..types.cloud import PointCloud

_MOST = 50_000
"""Points of either side, about, that are looked at: for shares, as good as all."""


def share_matches(
    source: PointCloud, placed: PointCloud, owner: Indices, overlap: float
) -> list[float]:
    """Tell which share of a pass's matches lies in each of the passes it was laid on.

    Args:
        source: The points of the pass, in place.
        placed: Those of all passes that were there before.
        owner: Number of the pass that each of these belongs to.
        overlap: Share of the source that was matched: its points nearest to the others.

    Returns:
        A share for each number up to the highest owner; together 1.
    """
    there, here = (slice(None, None, max(len(c) // _MOST, 1)) for c in (placed, source))
    away, nearest = KDTree(placed.points[there]).query(source.points[here])
    matched = np.asarray(away) <= np.quantile(away, min(overlap, 1.0))
    counts = np.bincount(owner[there][np.asarray(nearest)[matched]])
    return (counts / counts.sum()).tolist()
