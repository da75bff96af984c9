"""The part of the points' uncertainty that a whole scan shares."""

import os
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from ..optics.seen_points import shifts_in_world
from ..project import MOTION, Project, load_scan_rig
from ..types.arrays import Ratios
from ..types.profile import Profile
from ..types.rig import Rig
from ..types.trajectory import Trajectory

_PART = 20_000
"""Points that one thread works on: some ten megabytes."""


def spread_common(profile: Profile, trajectory: Trajectory, rig: Rig) -> Ratios:
    """Compute the common standard deviation of each point, in the direction where it is largest.

    Args:
        profile: The points, with the pixels that they come from.
        trajectory: world_from_camera, with its errors.
        rig: The rig, as it moves in this scan.

    Returns:
        Standard deviations [m]; 0 where neither the rig nor the motion states any, NaN where a
        pixel sees no point.
    """
    sigma = np.zeros(len(profile), np.float32)
    if not rig.covariance.names and trajectory.errors is None:
        return sigma

    def run(start: int) -> None:
        part = slice(start, start + _PART)
        shifts = shifts_in_world(profile[part], trajectory, rig)
        seen = np.isfinite(shifts).all(axis=(1, 2))
        covariances = shifts[seen] @ shifts[seen].transpose(0, 2, 1)
        largest = np.full(len(seen), np.nan)
        largest[seen] = np.sqrt(np.maximum(np.linalg.eigvalsh(covariances)[:, -1], 0.0))
        sigma[part] = largest

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(run, range(0, len(profile), _PART)))
    return sigma


def list_unstated(project: Project) -> list[str]:
    """Say whose errors are in no interval of a scan, since nothing is stated of them."""
    said = []
    if not load_scan_rig(project).covariance.names:
        said.append(
            "The rig file states no covariance: the rig's error is unknown, and in no interval; "
            "murkscan calibrate finds it."
        )
    if not project.finished(MOTION).result.accuracy:
        said.append(
            "The log of the poses states no uncertainty: the motion's error is in no interval; say "
            "in [navigation] of the rig file how good the vehicle's instruments are."
        )
    return said
