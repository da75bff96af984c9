"""What each frame gave, and the same over time in as many steps as a figure can show."""

import itertools
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from ..types.arrays import FrameNumbers, Indices, Scalars
from ..types.frame_times import FrameTimes
from ..types.profile import Profile

SHARES = (0.05, 0.5, 0.95)
"""The quantiles that are followed."""
MOST_STEPS = 400
"""Steps of a timeline, at most."""

Quantiles = Float[np.ndarray, "n 3"]


@dataclass(frozen=True, eq=False)
class FrameStatistics:
    """What frames gave; one a row, in order."""

    frame: FrameNumbers
    points: Indices
    """Number of points."""
    signal: Quantiles
    """5 %, median and 95 % of the signal [grey levels]; NaN without points."""
    depth: Quantiles
    """The same of the points' z in the camera frame [m]."""


@dataclass(frozen=True, eq=False)
class Timeline:
    """The same over time; one step of time a row, each of as many frames."""

    time: Scalars
    """Mean recording time of the step's frames [s]."""
    frames: Indices
    """Number of frames that were read."""
    empty: Indices
    """Number of those without any point."""
    points: Scalars
    """Mean number of points a frame."""
    signal: Quantiles
    """Median over the step's frames of their 5 %, median and 95 % signal [grey levels]."""
    depth: Quantiles
    """The same of the depth [m]."""


def frame_statistics(profile: Profile) -> FrameStatistics:
    """Count and measure the points of each frame that has any."""
    frame, points = np.unique(profile.frame, return_counts=True)
    return FrameStatistics(
        frame=frame,
        points=points,
        signal=_quantiles(profile.frame, points, profile.signal.astype(np.float64)),
        depth=_quantiles(profile.frame, points, profile.points[:, 2]),
    )


def make_timeline(frames: FrameTimes, parts: list[FrameStatistics]) -> Timeline:
    """Put the statistics of all frames in order of time, several frames a step where they are many.

    Args:
        frames: The frames that were read, with or without points.
        parts: Statistics of frames that gave points; no frame in two of them.
    """
    num_frames = len(frames)
    points = np.zeros(num_frames, np.int64)
    signal, depth = (np.full((num_frames, len(SHARES)), np.nan) for _ in range(2))
    for part in parts:
        rows = np.searchsorted(frames.frame, part.frame)
        points[rows], signal[rows], depth[rows] = part.points, part.signal, part.depth
    edges = np.linspace(0, num_frames, min(num_frames, MOST_STEPS) + 1).astype(int)
    steps = [slice(a, b) for a, b in itertools.pairwise(edges)]
    return Timeline(
        time=np.array([frames.time[s].mean() for s in steps]),
        frames=np.diff(edges),
        empty=np.array([np.count_nonzero(points[s] == 0) for s in steps], int),
        points=np.array([points[s].mean() for s in steps]),
        signal=_medians(signal, steps),
        depth=_medians(depth, steps),
    )


def _quantiles(frame: FrameNumbers, counts: Indices, values: Scalars) -> Quantiles:
    """Give the quantiles of the values of each frame: the nearest ranks, frames in order."""
    ordered = values[np.lexsort((values, frame))]
    first = np.cumsum(counts) - counts
    ranks = [first + np.rint(share * (counts - 1)).astype(np.int64) for share in SHARES]
    return np.stack([ordered[rank] for rank in ranks], axis=1)


def _medians(values: Quantiles, steps: list[slice]) -> Quantiles:
    """Give the median of each step's rows that have values; NaN where none has."""
    medians = np.full((len(steps), values.shape[1]), np.nan)
    for number, step in enumerate(steps):
        rows = values[step][np.isfinite(values[step]).all(axis=1)]
        if len(rows):
            medians[number] = np.median(rows, axis=0)
    return medians
