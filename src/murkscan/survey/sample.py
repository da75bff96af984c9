"""The points of a scan as measures want them: seen from where, and moved by what."""

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from ..errors import NotEnoughData
from ..geometry.stripe_blur import Sight
from ..measure import Sample, Selection
from ..optics import light_across, refractive_index
from ..optics.uncertainty import common_shifts
from ..project import Project
from ..types.arrays import Indices, Vector
from ..types.cloud import PointCloud
from ..types.profile import Profile
from ..types.rig import Rig
from ..types.trajectory import Trajectory
from .merged import is_merged
from .merged_errors import trace_alignment
from .scan_rig import load_scan_rig, moving_rig

_FEWEST = 10
"""Points of a selection below which a measure says nothing."""


def load_sample(project: Project, selection: Selection | None = None) -> Sample:
    """Load the points of a scan's cloud, or a part of them.

    Raises:
        MissingResult: The cloud stage has not been finished.
        NotEnoughData: Fewer than ten points are chosen.
        InputError: A point is not finite.
    """
    cloud = project.load_cloud()
    sample = _know_all(project, cloud)
    if selection is None:
        return sample
    chosen = selection.contains(cloud.points)
    if np.count_nonzero(chosen) < _FEWEST:
        low, high = cloud.points.min(axis=0), cloud.points.max(axis=0)
        raise NotEnoughData(
            f"The selection holds {np.count_nonzero(chosen)} of {len(cloud)} points, at least "
            f"{_FEWEST} are needed; the scan reaches from {_place(low)} to {_place(high)} m."
        )
    return sample[chosen]


def _know_all(project: Project, cloud: PointCloud) -> Sample:
    """Say of a cloud what is known of it; of a merged one neither ways nor rigs are kept."""
    if len(cloud) and is_merged(project):
        return Sample.from_cloud(cloud, shifts=trace_alignment(project, cloud))
    if len(cloud) == 0:
        return Sample.from_cloud(cloud)
    rig, trajectory = moving_rig(project, load_scan_rig(project)), project.load_trajectory()
    profile = Profile.concatenate(list(project.load_kept_parts()))

    def shifts(some: Indices) -> Float[np.ndarray, "n 3 modes"]:
        return _shift(profile[some], trajectory, rig)

    return Sample.from_cloud(
        cloud,
        sight=_look_back(cloud, profile, trajectory, rig),
        shifts=shifts if rig.covariance.names else None,
    )


def _look_back(cloud: PointCloud, profile: Profile, trajectory: Trajectory, rig: Rig) -> Sight:
    """Find from where each point was seen."""
    cameras = trajectory.transform(np.zeros_like(cloud.points), profile.time)
    rays = cloud.points - cameras
    rays /= np.maximum(np.linalg.norm(rays, axis=1, keepdims=True), 1e-12)
    axes = {laser: rig.lasers[laser].axis for laser in np.unique(cloud.laser).tolist()}
    across = np.array([axes[laser] == "x" for laser in cloud.laser.tolist()])
    stripe = np.where(across[:, None], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0])
    along = trajectory.transform(stripe, profile.time) - cameras
    index = refractive_index(rig.water, rig.wavelength)
    lights = {laser: light_across(rig.lasers[laser], index) for laser in axes}
    light = np.array([lights[laser] for laser in cloud.laser.tolist()])
    return Sight(rays, along, trajectory.transform(light, profile.time) - cameras)


def _shift(profile: Profile, trajectory: Trajectory, rig: Rig) -> Float[np.ndarray, "n 3 modes"]:
    shifts = np.zeros((len(profile), 3, 0))
    for laser in np.unique(profile.laser):
        mine = profile.laser == laser
        found = common_shifts(profile.pixels[mine], rig, int(laser))
        if shifts.shape[2] == 0:
            shifts = np.zeros((len(profile), 3, found.shape[2]))
        shifts[mine] = found
    moments, which = np.unique(profile.time, return_inverse=True)
    attitudes = Rotation.from_quat(trajectory.at(moments).quaternions, scalar_first=True)
    world_from_rig = attitudes.as_matrix()
    if rig.vehicle_from_camera is not None:
        world_from_rig = world_from_rig @ rig.vehicle_from_camera.rotation.T
    return world_from_rig[which] @ shifts


def _place(point: Vector) -> str:
    return ",".join(f"{part:.3f}" for part in point)
