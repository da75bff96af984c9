"""Merge a scan's profiles into one cloud."""

import time
from dataclasses import replace
from typing import Any

from ..cloud import merge_profiles, remove_outliers
from ..project import Project
from ..types.rig import Rig
from .common_part import moving_rig, spread_common
from .progress import Progress, silent
from .settings import describe

FRAME_FILES = 500
"""Frames up to which the paper's one cloud a frame is written without being asked for."""


def build_cloud(
    project: Project, rig: Rig, *, frames: bool = False, progress: Progress = silent
) -> dict[str, Any]:
    """Run the cloud stage.

    Args:
        project: A scan with finished triangulate and motion stages.
        rig: Its rig.
        frames: Whether to write one cloud a frame for more than 500 frames, too.
        progress: Told when it begins and when it is done.

    Returns:
        Counts: points, and outliers that were taken out.

    Raises:
        MissingResult: An earlier stage has not been finished.
        DeviceError: The disk is full.
    """
    inputs = {name: project.finished(name).digest for name in ("triangulate", "motion")}
    rig = moving_rig(project, rig)
    stage = project.stage(
        "cloud",
        settings={"frames": frames},
        inputs=inputs | {"covariance": describe(rig.covariance)},
    )
    if (result := stage.result()) is not None:
        return result
    since = time.monotonic()
    stage.begin()
    progress("cloud", 0, None)
    profile, trajectory = project.load_profile(), project.load_trajectory()
    laser = project.finished("extract").key["settings"]["laser"]
    merged = merge_profiles(profile, trajectory, axis=rig.lasers[laser].axis)
    merged = replace(merged, sigma_common=spread_common(profile, rig))
    cloud = remove_outliers(merged)
    project.save_cloud(cloud)
    if frames or project.finished("extract").counts()["frames"] <= FRAME_FILES:
        project.save_frames(cloud)
    result = {"points": len(cloud), "outliers": len(merged) - len(cloud)}
    stage.finish(result, since=since)
    progress("cloud", 1, 1)
    return result
