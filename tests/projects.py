"""Folders of scans of which only some stages are there."""

import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from murkscan.project import (
    CLOUD,
    EXTRACT,
    MOTION,
    TRIANGULATE,
    CloudResult,
    ExtractResult,
    Kind,
    MotionResult,
    Project,
    RecordingRecord,
    ScanRecord,
    Stage,
    TriangulateResult,
)
from murkscan.types.cloud import PointCloud
from murkscan.types.cloud_part import CloudPart
from murkscan.types.profile import Profile
from murkscan.types.trajectory import Trajectory

RECORDING = RecordingRecord("dive.mkv", "1", (640, 480), is_timed=True, fields_per_picture=1)
SCAN = ScanRecord(versions={}, recording=RECORDING, rig={})
MERGED = ScanRecord(versions={}, recording=None, rig={})


def finish(
    project: Project,
    kind: Kind[Any],
    result: Any,
    *,
    inputs: Mapping[str, Any] | None = None,
    make: Callable[[], object] = lambda: None,
    label: str = "",
) -> Stage[Any]:
    """Finish a stage with a result and with the files that `make` saves."""
    stage = project.stage(kind, settings={}, inputs=inputs or {}, label=label)
    stage.begin()
    make()
    stage.finish(result, since=time.monotonic())
    return stage


def save_cloud(project: Project, cloud: Any) -> None:
    project.save_cloud_part(0, CloudPart.whole(cloud))
    project.export_cloud(frames=False)


def as_project(root: Path, cloud: PointCloud) -> Project:
    """Make a project of which only the cloud is there."""
    project = Project(root)
    project.save_scan(SCAN)
    result = CloudResult(len(cloud), outliers=0)
    finish(project, CLOUD, result, make=lambda: save_cloud(project, cloud))
    return project


def scanned(root: Path, profile: Profile, trajectory: Trajectory, *, parts: int) -> Project:
    """Make a project with finished extract, triangulate and motion, cut into parts."""
    project = Project(root)
    project.save_scan(SCAN)
    inputs = {
        "extract": finish(project, EXTRACT, ExtractResult((0,), 120, 0, 0, len(profile))).digest
    }

    def save_parts() -> None:
        for number, frames in enumerate(np.array_split(np.unique(profile.frame), parts)):
            project.save_profile_part(number, profile[np.isin(profile.frame, frames)])

    triangulated = TriangulateResult(len(profile), dropped=0)
    finish(project, TRIANGULATE, triangulated, inputs=inputs, make=save_parts)
    # As a motion gives them: a pose for each frame.
    poses = trajectory.at(np.unique(profile.time)) if len(profile) else trajectory
    moved = MotionResult(len(poses.times))
    finish(project, MOTION, moved, inputs=inputs, make=lambda: project.save_trajectory(poses))
    return project
