"""The points of a scan as measures want them: seen from where, and moved by what."""

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from ..errors import NotEnoughData
from ..measure import Sample, Selection
from ..optics.seen_points import look_back, shifts_in_world
from ..project import CLOUD, TRIANGULATE, Project, is_merged, load_moving_rig
from ..project.merged import load_merged_errors
from ..types.arrays import Indices, Vector
from ..types.cloud import PointCloud
from ..types.profile import Profile

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
    if len(cloud) == 0:
        sample = Sample.from_cloud(cloud)
    else:
        sample = (_know_merged if is_merged(project) else _know_scan)(project, cloud)
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


def _know_scan(project: Project, cloud: PointCloud) -> Sample:
    """Say of a scan's points what their profiles know."""
    rig, trajectory = load_moving_rig(project), project.load_trajectory()
    profile = Profile.concatenate(list(project.load_kept_parts()))

    def shifts(some: Indices) -> Float[np.ndarray, "n 3 modes"]:
        return shifts_in_world(profile[some], trajectory, rig)

    pulls = project.finished(TRIANGULATE).result.paint_pulls
    pulled_back = np.isin(cloud.laser, [pull.laser for pull in pulls]) if pulls else None
    sight = look_back(cloud, profile.time, trajectory, rig)
    return Sample.from_cloud(
        cloud,
        sight=replace(sight, pulled_back=pulled_back),
        shifts=shifts if rig.covariance.names or trajectory.errors is not None else None,
    )


def _know_merged(project: Project, cloud: PointCloud) -> Sample:
    """Say of the points of a merged cloud what its passes' rigs, poses and alignments know."""
    errors = load_merged_errors(project)
    owner = project.finished(CLOUD).result.number_passes(cloud.frame)

    def shifts(some: Indices) -> Float[np.ndarray, "n 3 modes"]:
        return errors.shifts(owner[some], cloud[some])

    return Sample.from_cloud(
        cloud,
        sight=errors.look_back(owner, cloud),
        shifts=shifts if errors.is_stated else None,
        num_alignments=errors.num_alignments,
    )


def _place(point: Vector) -> str:
    return ",".join(f"{part:.3f}" for part in point)
