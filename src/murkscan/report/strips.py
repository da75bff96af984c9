"""The strips of surface between neighbours on a scan line: covered, or missing and why."""

from dataclasses import dataclass

import numpy as np

from ..types.arrays import Indices, Scalars
from .reach import Reach
from .swath import COVERED, NO_LIGHT, NO_STRIPE, NOTHING, OCCLUDED, TOO_FAST, UNREADABLE, Swath


@dataclass(frozen=True, eq=False)
class Strips:
    """Narrow strips along the motion, each as wide as a scan line; one a row."""

    start: Scalars
    """Where it begins, along the motion [m]."""
    length: Scalars
    """How long it is, along the motion [m]."""
    across: Scalars
    """Where its middle is, across the motion [m]."""
    lean: Scalars
    """How far it goes across from its beginning to its end [m]."""
    width: Scalars
    """How wide it is [m]."""
    cause: Indices
    """COVERED, or why it is missing."""


def cut_strips(swath: Swath, *, hole: float, pitch: float, reach: Reach) -> Strips:
    """Join each sample to the next one of its scan line, and tell why there is a hole.

    Args:
        swath: Samples, rows in order of time.
        hole: Distance along the motion of neighbours above which there is a hole between them [m].
        pitch: Distance of neighbouring scan lines for each metre of depth.
        reach: How far the light went.
    """
    line, row = np.nonzero((swath.cause != NOTHING).T)
    is_pair = np.diff(line) == 0
    one, two = (row[:-1][is_pair], line[:-1][is_pair]), (row[1:][is_pair], line[1:][is_pair])
    way = swath.camera[two] - swath.camera[one]
    step = swath.along[two] - swath.along[one]
    # Where the surface comes nearer, the stripe may fall back: nothing is missing then.
    length = np.maximum(step * np.where(way < 0, -1, 1), 0)
    cause = _causes(swath, one, two, length, way, hole)
    far = (swath.range[one] + swath.range[two]) / 2
    return Strips(
        start=np.minimum(swath.along[one], swath.along[two]),
        length=length,
        across=(swath.across[one] + swath.across[two]) / 2,
        lean=(swath.across[two] - swath.across[one]) * np.where(step < 0, -1, 1),
        width=pitch * (swath.depth[one] + swath.depth[two]) / 2,
        cause=np.where(cause == NO_LIGHT, reach.tell(far), cause),
    )


_Places = tuple[Indices, Indices]


def _causes(
    swath: Swath, one: _Places, two: _Places, length: Scalars, way: Scalars, hole: float
) -> Indices:
    """Tell why each strip is missing; the first that applies, from the surest to the least."""
    inside = np.maximum(swath.cause[one], swath.cause[two]).astype(np.int64)
    is_hidden = (swath.cause[one] == OCCLUDED) | (swath.cause[two] == OCCLUDED)
    inside[is_hidden] = OCCLUDED
    frames, read, lit = (
        getattr(swath, name)[two] - getattr(swath, name)[one] for name in ("frame", "read", "lit")
    )
    between_lit = lit - 1
    between_dark, between_lost = read - lit, frames - read
    is_steep = np.abs(swath.height[two] - swath.height[one]) > length
    is_lost = (between_dark + between_lost > 0) & (between_dark + between_lost >= between_lit)
    rules = [
        (length <= hole) & (inside == COVERED),
        inside != COVERED,
        np.abs(way) > hole * np.maximum(frames, 1),
        is_lost & (between_lost > between_dark),
        is_lost,
        is_steep,
        between_lit > 0,
    ]
    results = [COVERED, inside, TOO_FAST, UNREADABLE, NO_STRIPE, OCCLUDED, NO_LIGHT]
    # What is left are neighbours in time on a surface that slopes away: slower would close it.
    return np.select(rules, results, TOO_FAST)
