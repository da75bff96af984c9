"""Projects whose cloud was merged from other scans: they have no recording."""

from contextlib import suppress

import numpy as np

from ..errors import FormatError, InputError, MissingResult
from ..project import CLOUD, Project
from ..types.cloud import PointCloud
from ..types.frame_times import FrameTimes
from ..types.trajectory import Trajectory


def is_merged(project: Project) -> bool:
    """Tell whether a project's cloud was merged from others, so that no stage can make it anew."""
    with suppress(MissingResult, FormatError):
        return project.load_scan().merged is not None
    return False


def require_recording(project: Project) -> None:
    """Refuse what needs a recording where there is none.

    Raises:
        InputError: The cloud was merged from other scans.
    """
    if is_merged(project):
        raise InputError(
            f"{project.root} was merged from other scans and has no recording of its own; give one "
            "of those, or another folder."
        )


def load_way(project: Project) -> Trajectory | None:
    """Give how the camera went through the world; None for clouds of which one has no poses.

    Raises:
        MissingResult: A scan's motion stage has not been finished.
    """
    try:
        return project.load_trajectory()
    except MissingResult:
        if is_merged(project):
            return None
        raise


def load_moments(project: Project) -> FrameTimes | None:
    """Give the time of each frame; None where no poses are known.

    Merged scans follow on one another, whenever they were made: the frame's number stands for its
    time.
    """
    if not is_merged(project):
        return project.load_frame_times()
    way = load_way(project)
    return None if way is None else FrameTimes(way.times.astype(np.uint32), way.times)


def split_passes(project: Project, cloud: PointCloud) -> list[PointCloud]:
    """Give the points of each pass of a merged cloud, those without any left out; else all.

    Raises:
        MissingResult: The cloud stage has not been finished.
    """
    if not is_merged(project):
        return [cloud]
    ranges = [one.frames for one in project.finished(CLOUD).result.passes]
    parts = [cloud[(cloud.frame >= low) & (cloud.frame <= high)] for low, high in ranges]
    return [part for part in parts if len(part)]
