"""How far the points of a merged cloud move with the errors of its passes' alignment."""

from collections.abc import Callable, Sequence

import numpy as np
from jaxtyping import Float

from ..geometry.alignment_fit import sensitivity
from ..project import CLOUD, AlignmentResult, PassResult, Project
from ..types.arrays import Indices, Points
from ..types.cloud import PointCloud


def trace_alignment(
    project: Project, cloud: PointCloud
) -> Callable[[Indices], Float[np.ndarray, "n 3 modes"]] | None:
    """Give how points of a merged cloud move with the errors of its passes' alignment [m].

    Six independent ones for each pass that was moved, at one standard deviation. They move it, and
    what was laid on it, by the share of its matches. What the passes' rigs share is not among them.
    None where nothing was aligned.
    """
    passes = project.finished(CLOUD).result.passes
    moved = {number: one.alignment for number, one in enumerate(passes) if one.alignment}
    if not moved:
        return None
    first_frames = [one.frames[0] for one in passes]
    carried = _carry(passes)

    def shifts(some: Indices) -> Float[np.ndarray, "n 3 modes"]:
        points = cloud.points[some]
        owner = np.searchsorted(first_frames, cloud.frame[some], side="right") - 1
        parts = [
            _move(alignment, points) * carried[owner, number, None, None]
            for number, alignment in moved.items()
        ]
        return np.concatenate(parts, axis=2)

    return shifts


def _carry(passes: Sequence[PassResult]) -> Float[np.ndarray, "passes passes"]:
    """Give how far each pass (row) goes along with the error of each (column).

    A pass errs by itself, and by its shares of those that it was laid on: C = 1 + S C.
    """
    shares = np.zeros((len(passes),) * 2)
    for row, one in zip(shares, passes, strict=True):
        row[: len(one.laid_on)] = one.laid_on
    return np.linalg.inv(np.eye(len(passes)) - shares)


def _move(alignment: AlignmentResult, points: Points) -> Float[np.ndarray, "n 3 modes"]:
    """Move points by each error of an alignment."""
    size, axes = np.linalg.eigh(np.array(alignment.covariance_of_turn_and_shift))
    modes = axes * np.sqrt(np.maximum(size, 0.0))
    along = [
        sensitivity(points - np.array(alignment.centre), np.tile(axis, (len(points), 1)), 1.0)
        for axis in np.eye(3)
    ]
    return np.stack(along, axis=1) @ modes
