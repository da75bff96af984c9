"""The points of a scan's profiles that its cloud has kept."""

from collections.abc import Iterator

import numpy as np
from jaxtyping import Int

from ..project import Project
from ..types.cloud import PointCloud
from ..types.laser import Axis
from ..types.profile import Profile

Keys = Int[np.ndarray, "keys"]


def kept_profiles(project: Project, axis: Axis) -> Iterator[Profile]:
    """Give the profiles part by part, without the points that were taken out as outliers.

    Args:
        project: A scan with a finished cloud stage.
        axis: The camera axis along which the laser sits.

    Raises:
        MissingResult: A stage has not been finished.
        FormatError: A file is damaged.
    """
    blocks = project.iterate_cloud()
    keys, last = np.zeros(0, np.int64), -1
    for part in project.load_profile_parts():
        wanted = int(part.frame.max(initial=0))
        while last <= wanted and (block := next(blocks, None)) is not None:
            if len(block):
                keys, last = np.concatenate([keys, _keys_of_cloud(block)]), int(block.frame.max())
        yield part[np.isin(_keys_of_profile(part, axis), keys)]
        keys = keys[keys >> _FRAME > wanted]


_FRAME, _LINE = 32, 16
"""Bits of a key below the number of its frame, and below its scan line."""


def _keys_of_cloud(cloud: PointCloud) -> Keys:
    return _keys(cloud.frame, cloud.scan_line, cloud.signal)


def _keys_of_profile(profile: Profile, axis: Axis) -> Keys:
    line = np.rint(profile.pixels[:, 0 if axis == "y" else 1])
    return _keys(profile.frame, line, profile.signal)


def _keys(frame: np.ndarray, line: np.ndarray, signal: np.ndarray) -> Keys:
    """Number points by frame, scan line, and the signal, which parts the branches of a line."""
    bits = np.ascontiguousarray(signal, np.float32).view(np.uint32).astype(np.int64)
    mixed = (bits ^ (bits >> _LINE)) & ((1 << _LINE) - 1)
    return (frame.astype(np.int64) << _FRAME) + (line.astype(np.int64) << _LINE) + mixed
