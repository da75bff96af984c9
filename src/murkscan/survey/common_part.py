"""The part of the points' uncertainty that a whole scan shares."""

import os
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from ..optics.uncertainty import common_sigma
from ..types.arrays import Ratios
from ..types.profile import Profile
from ..types.rig import Rig

_PART = 50_000
"""Points that one thread works on."""


def spread_common(profile: Profile, rig: Rig) -> Ratios:
    """Give the common standard deviation of each point [m]; 0 where the rig states none.

    Args:
        profile: The points, with the pixels that they come from.
        rig: The rig, as it moves in this scan.
    """
    sigma = np.zeros(len(profile), np.float32)
    if not rig.covariance.names:
        return sigma
    parts = [
        mine[start : start + _PART]
        for mine in (np.flatnonzero(profile.laser == n) for n in np.unique(profile.laser))
        for start in range(0, len(mine), _PART)
    ]

    def run(part: np.ndarray) -> None:
        sigma[part] = common_sigma(profile.pixels[part], rig, int(profile.laser[part[0]]))

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(run, parts))
    return sigma
