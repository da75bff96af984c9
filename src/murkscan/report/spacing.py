"""How far apart neighbouring points lie: along a profile, and across to the next."""

from dataclasses import replace

import numpy as np

from ..geometry.grid import line_step
from ..types.arrays import Indices, Scalars
from ..types.laser import Axis
from ..types.profile import Profile
from ..types.trajectory import Trajectory

_LARGEST_GAP = 2
"""Frames from one point of a scan line to its neighbour: fields share their rows with every second
field only."""


def spacing_along(profile: Profile, axis: Axis) -> Scalars:
    """Give the distances of points on neighbouring scan lines of one frame [m].

    In the fields of interlaced video neighbouring scan lines may be two image rows apart.

    Args:
        profile: Points of whole frames; where a scan line has several, the strongest counts.
        axis: The camera axis along which the laser sits.
    """
    points, frame, line = _one_per_line(profile, axis)
    order = np.lexsort((line, frame))
    step = line_step(np.unique(frame, return_inverse=True)[1], line)
    is_next = (np.diff(frame[order]) == 0) & (np.diff(line[order]) == step)
    return _steps(points[order], is_next)


def spacing_across(profile: Profile, trajectory: Trajectory, axis: Axis) -> Scalars:
    """Give the distances of points on the same scan line of successive frames [m].

    Args:
        profile: Points of whole frames; where a scan line has several, the strongest counts.
        trajectory: world_from_camera.
        axis: The camera axis along which the laser sits.
    """
    in_world = replace(profile, points=trajectory.transform(profile.points, profile.time))
    points, frame, line = _one_per_line(in_world, axis)
    order = np.lexsort((frame, line))
    gap = np.diff(frame[order])
    is_next = (np.diff(line[order]) == 0) & (gap >= 1) & (gap <= _LARGEST_GAP)
    return _steps(points[order], is_next)


def pick_strongest(profile: Profile, axis: Axis) -> Indices:
    """Pick the strongest point of each frame's scan lines, in order of frames and lines."""
    line = _scan_line(profile, axis)
    frame = profile.frame.astype(np.int64)
    order = np.lexsort((-profile.signal, line, frame))
    is_first = np.ones(len(order), bool)
    is_first[1:] = (np.diff(frame[order]) != 0) | (np.diff(line[order]) != 0)
    return order[is_first]


def _one_per_line(profile: Profile, axis: Axis) -> tuple[np.ndarray, Indices, Indices]:
    """Give points, frames and scan lines, with the strongest point of each scan line alone."""
    kept = profile[pick_strongest(profile, axis)]
    return kept.points, kept.frame.astype(np.int64), _scan_line(kept, axis)


def _scan_line(profile: Profile, axis: Axis) -> Indices:
    return np.rint(profile.pixels[:, 0 if axis == "y" else 1]).astype(np.int64)


def _steps(points: np.ndarray, is_next: np.ndarray) -> Scalars:
    return np.linalg.norm(np.diff(points, axis=0)[is_next], axis=1)
