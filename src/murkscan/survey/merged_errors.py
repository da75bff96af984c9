"""How far the points of a merged cloud move with the errors of its passes' alignment."""

from collections.abc import Callable
from typing import Any

import numpy as np
from jaxtyping import Float

from ..geometry.alignment_fit import sensitivity
from ..project import Project
from ..types.arrays import Indices, Points, SignedFrameNumbers
from ..types.cloud import PointCloud


def trace_alignment(
    project: Project, cloud: PointCloud
) -> Callable[[Indices], Float[np.ndarray, "n 3 modes"]] | None:
    """Give how points of a merged cloud move with the errors of its passes' alignment [m].

    Six independent ones for each pass that was moved, at one standard deviation. What the passes'
    rigs share is not among them. None where nothing was aligned.
    """
    moved = [one for one in project.finished("cloud").counts()["passes"] if one["alignment"]]
    if not moved:
        return None

    def shifts(some: Indices) -> Float[np.ndarray, "n 3 modes"]:
        parts = [_move(one, cloud.points[some], cloud.frame[some]) for one in moved]
        return np.concatenate(parts, axis=2)

    return shifts


def _move(
    one: dict[str, Any], points: Points, frame: SignedFrameNumbers
) -> Float[np.ndarray, "n 3 modes"]:
    """Move the points of one pass by each error of its alignment; the others stay."""
    alignment = one["alignment"]
    first, last = one["frames"]
    size, axes = np.linalg.eigh(np.array(alignment["covariance_of_turn_and_shift"]))
    modes = axes * np.sqrt(np.maximum(size, 0.0))
    along = [
        sensitivity(points - np.array(alignment["centre_m"]), np.tile(axis, (len(points), 1)), 1.0)
        for axis in np.eye(3)
    ]
    mine = (frame >= first) & (frame <= last)
    return np.stack(along, axis=1) @ modes * mine[:, None, None]
