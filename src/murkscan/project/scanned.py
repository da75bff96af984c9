"""What a scan's folder says of its recording, its rig, and how the camera went."""

from contextlib import suppress
from dataclasses import replace

from ..errors import FormatError, InputError, MissingResult
from ..io.rig_toml import parse_rig
from ..types.frame_times import FrameTimes
from ..types.rig import Rig
from ..types.trajectory import Trajectory
from .folder import Project
from .kinds import MOTION
from .scan_record import RecordingRecord


def is_merged(project: Project) -> bool:
    """Tell whether a project's cloud was merged from others, so that no stage can make it anew."""
    with suppress(MissingResult, FormatError):
        return project.load_scan().recording is None
    return False


def load_recording(project: Project) -> RecordingRecord:
    """Read what scan.json says of the recording.

    Raises:
        MissingResult: The folder holds no scan.
        InputError: It was merged from other scans.
    """
    recording = project.load_scan().recording
    if recording is None:
        raise InputError(
            f"{project.root} was merged from other scans and has no recording of its own; give one "
            "of those, or another folder."
        )
    return recording


def load_scan_rig(project: Project) -> Rig:
    """Read the rig as it was when the scan began.

    Raises:
        MissingResult: The folder holds no scan.
        InputError: It was merged from other scans.
    """
    load_recording(project)
    name = f"{project.root / 'scan.json'}: rig"
    return parse_rig(dict(project.load_scan().rig), name=name)


def load_moving_rig(project: Project) -> Rig:
    """Read the rig as it moves: without its mount, where the scan's motion is the camera's own.

    Raises:
        MissingResult: The motion stage has not been finished.
        InputError: The folder was merged from other scans.
    """
    return as_it_moves(
        load_scan_rig(project), carries_mount=project.finished(MOTION).result.carries_mount
    )


def as_it_moves(rig: Rig, *, carries_mount: bool) -> Rig:
    """Leave out the mount of a rig whose poses did not come through it."""
    if carries_mount:
        return rig
    covariance = rig.covariance.without("mount.")
    return replace(rig, vehicle_from_camera=None, covariance=covariance)


def find_trajectory(project: Project) -> Trajectory | None:
    """Read how the camera went through the world; None where a merged pass does not say.

    Raises:
        MissingResult: A scan's motion stage has not been finished.
    """
    if not is_merged(project):
        return project.load_trajectory()
    with suppress(MissingResult):
        if not project.finished(MOTION).result.frames_without_pose:
            return project.load_trajectory()
    return None


def find_frame_times(project: Project) -> FrameTimes | None:
    """Read the time of each frame; None where a merged pass has no poses.

    Merged scans follow on one another, whenever they were made: the frame's number stands for its
    time.
    """
    if not is_merged(project):
        return project.load_frame_times()
    trajectory = find_trajectory(project)
    if trajectory is None:
        return None
    return FrameTimes(trajectory.times.astype("uint32"), trajectory.times)
