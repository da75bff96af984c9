"""From a scan's profiles to a pass that can be adjusted."""

from collections.abc import Iterable, Sequence

import numpy as np

from ...geometry.grid import line_step
from ...types.arrays import Mask, Scalars
from ...types.laser import Axis
from ...types.navigation import Navigation
from ...types.pose import Pose
from ...types.profile import Profile
from .legs import Pass

_LEAST_POSTERIOR = 0.5
"""As the cloud has it: less is no surface."""
_MOST_LINES = 400
"""Scan lines of a profile that are used, at most: more of them lie in the same facets."""


def make_pass(
    parts: Iterable[Profile],
    times: Scalars,
    axes: Sequence[Axis],
    vehicle_from_camera: Pose,
    navigation: Navigation,
) -> Pass:
    """Gather a scan's points, of each scan line the strongest one.

    Args:
        parts: The profiles, in order of frames.
        times: When frames were taken whose pose is known [s]; others are left out.
        axes: The camera axis along which each laser sits.
        vehicle_from_camera: The mount.
        navigation: What the vehicle's instruments measured, by the recording's clock.
    """
    kept = [part[_are_first(part) & np.isin(part.time, times)] for part in parts]
    lines = [_scan_lines(part, axes) for part in kept]
    every = max((-(-int(np.ptp(one)) // _MOST_LINES) for one in lines if len(one)), default=1)
    every = max(every, 1)
    chosen = [one % every == 0 for one in lines]
    profile = Profile.concatenate([p[c] for p, c in zip(kept, chosen, strict=True)])
    line = np.concatenate([one[c] // every for one, c in zip(lines, chosen, strict=True)])
    order = np.lexsort((line, profile.laser, profile.time))
    profile, line = profile[order], line[order]
    return Pass(
        times,
        np.searchsorted(times, profile.time),
        line - line.min(initial=0),
        profile.laser,
        vehicle_from_camera @ profile.points,
        profile.signal.astype(float),
        navigation,
    )


def _are_first(profile: Profile) -> Mask:
    first: Mask = (profile.branch == 0) & (profile.posterior >= _LEAST_POSTERIOR)
    return first


def _scan_lines(profile: Profile, axes: Sequence[Axis]) -> np.ndarray:
    """Number each point's scan line; in fields neighbours are two image rows apart."""
    side = np.array([1 if axis == "x" else 0 for axis in axes], np.int64)[profile.laser]
    line = np.rint(profile.pixels[np.arange(len(profile)), side]).astype(np.int64)
    if len(line) == 0:
        return line
    _, which = np.unique(profile.frame, return_inverse=True)
    return np.asarray(line // line_step(which, line))
