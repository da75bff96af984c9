"""How far apart two lasers' surfaces lie by a log that nobody may change."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ..geometry.disagreement import Disagreement, find_disagreement
from ..types.cloud import PointCloud
from ..types.profile import Profile
from ..types.trajectory import Trajectory

_SIGMAS = 3.0
"""Standard deviations of a point by which noise, and curves between points, hold surfaces apart."""
_MOST = 400_000
"""Points of each laser that are compared, about."""


@dataclass(frozen=True, eq=False)
class SheetsApart:
    """Where both lasers passed, and how well their points are known."""

    between: Disagreement
    sigma: float
    """Median standard deviation of the points by their own noise [m]."""

    @property
    def is_noise(self) -> bool:
        """Whether their surfaces lie no farther apart than noise has them."""
        return self.between.rms < _SIGMAS * self.sigma


def compare_sheets(parts: Iterable[Profile], logged: Trajectory) -> SheetsApart | None:
    """Tell how far apart the surfaces of the first two lasers lie; None where they share none.

    Args:
        parts: The profiles, in order of frames.
        logged: world_from_camera.
    """
    profile = Profile.concatenate([part[logged.has(part.time)] for part in parts])
    lasers = np.unique(profile.laser)
    if len(lasers) < 2:
        return None
    one, other = (_as_cloud(profile[profile.laser == laser], logged) for laser in lasers[:2])
    between = find_disagreement(one, other)
    return None if between is None else SheetsApart(between, float(np.median(profile.sigma)))


def _as_cloud(profile: Profile, logged: Trajectory) -> PointCloud:
    """Carry some of the points to the world; normals are told from their neighbours."""
    some = profile[:: max(len(profile) // _MOST, 1)]
    count = len(some)
    return PointCloud(
        points=logged.transform(some.points, some.time),
        normals=np.zeros((count, 3), np.float32),
        signal=some.signal,
        posterior=some.posterior,
        sigma=some.sigma,
        sigma_common=np.zeros(count, np.float32),
        frame=some.frame.astype(np.int32),
        scan_line=np.zeros(count, np.int32),
        laser=some.laser,
        branch=some.branch,
    )
