"""From profiles in the camera frame to one cloud in the world frame."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..geometry.grid import ScanGrid
from ..types.cloud import PointCloud
from ..types.laser import Axis
from ..types.profile import Profile
from ..types.trajectory import Trajectory
from .normals import estimate_normals


def merge_profiles(profile: Profile, trajectory: Trajectory, *, axes: Sequence[Axis]) -> PointCloud:
    """Carry the points of all frames to the world frame and give them normals.

    Args:
        profile: The points of all frames, in the camera frame [m].
        trajectory: world_from_camera, over the times of the profile.
        axes: The camera axis along which each laser sits, as `Rig.axes`: scan lines are image rows
            for "x", image columns for "y".

    Returns:
        The points in the same order, in the world frame [m]. Normals are turned to the camera, and
        zero where a point has too few neighbours. sigma_common is zero: who knows the rig's
        covariance adds it.

    Raises:
        InputError: A time lies outside the trajectory, or a point is not finite.
    """
    side = np.array([1 if axis == "x" else 0 for axis in axes], np.int64)[profile.laser]
    across_stripe = profile.pixels[np.arange(len(profile)), side]
    cloud = PointCloud(
        points=trajectory.transform(profile.points, profile.time),
        normals=np.zeros((len(profile), 3), np.float32),
        signal=profile.signal,
        posterior=profile.posterior,
        sigma=profile.sigma,
        sigma_common=np.zeros(len(profile), np.float32),
        frame=profile.frame.astype(np.int32),
        scan_line=np.rint(across_stripe).astype(np.int32),
        laser=profile.laser,
        branch=profile.branch,
        blur_shift=profile.blur_shift,
        width=profile.width,
    )
    cameras = trajectory.transform(np.zeros_like(profile.points), profile.time)
    return replace(cloud, normals=estimate_normals(ScanGrid.from_cloud(cloud), cameras))
