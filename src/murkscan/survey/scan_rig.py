"""The recording of a project, and the rig that it was made with."""

from dataclasses import replace

from ..errors import InputError
from ..io.rig_toml import parse_rig
from ..project import MOTION, Project, RecordingRecord
from ..types.rig import Rig


def load_recording_record(project: Project) -> RecordingRecord:
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
    load_recording_record(project)
    name = f"{project.root / 'scan.json'}: rig"
    return parse_rig(dict(project.load_scan().rig), name=name)


def moving_rig(project: Project, rig: Rig) -> Rig:
    """Give the rig without its mount, where the scan's motion is the camera's own."""
    if project.finished(MOTION).result.carries_mount:
        return rig
    covariance = rig.covariance.without("mount.")
    return replace(rig, vehicle_from_camera=None, covariance=covariance)
