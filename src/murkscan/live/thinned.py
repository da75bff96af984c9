"""The preview's points: of those that share a cube one is enough to be looked at."""

import numpy as np

from ..geometry.voxels import VoxelGrid
from ..types.arrays import Points
from ..types.profile import Profile
from .folder import LivePoints


def thin_points(profile: Profile, points: Points, spacing: float) -> LivePoints:
    """Keep one point of each cube.

    Args:
        profile: The points' profiles.
        points: The same points in the world frame [m].
        spacing: Edge of a cube [m].
    """
    grid = VoxelGrid(points, spacing)
    chosen = np.sort(grid.order[grid.starts])
    return LivePoints(
        points[chosen].astype(np.float32), profile.signal[chosen], profile.frame[chosen]
    )
