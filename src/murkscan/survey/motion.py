"""Where the camera was in each frame of a scan."""

import time
from typing import Any

import numpy as np

from ..capture import AbstractRecording
from ..errors import InputError
from ..motion import AbstractMotion
from ..project import Project
from .settings import describe


def follow_motion(project: Project, motion: AbstractMotion) -> dict[str, Any]:
    """Run the motion stage.

    Returns:
        The duration [s], the length of the path [m], the number of poses, the frames that have
        none, and remarks on them.

    Raises:
        MissingResult: The extract stage has not been finished.
        InputError: The recording has no times and the motion needs them, or they lie outside its
            log.
    """
    recording = project.load_scan()["recording"]
    stage = project.stage(
        "motion",
        settings={"motion": describe(motion)},
        inputs={"extract": project.finished("extract").digest},
    )
    if (result := stage.result()) is not None:
        return result
    since = time.monotonic()
    check_times(recording["path"], motion, is_timed=recording["is_timed"])
    times = project.load_frame_times()
    pictures = times.frame.astype(float) / recording["fields_per_picture"]
    trajectory = motion.follow(times.time, pictures)
    stage.begin()
    project.save_trajectory(trajectory)
    steps = np.linalg.norm(np.diff(trajectory.positions, axis=0), axis=1)
    result = {
        "poses": len(trajectory.times),
        "frames_without_pose": len(times) - len(trajectory.times),
        "duration_s": float(np.ptp(times.time)),
        "length_m": float(steps.sum()),
        "remarks": list(motion.remarks(times.time)),
    }
    stage.finish(result, since=since)
    return result


_PROBES = 1000
"""Times of a recording at which a motion is asked beforehand, spread over it."""


def check_motion(recording: AbstractRecording, motion: AbstractMotion) -> None:
    """Refuse a motion that does not fit a recording's times, before anything is extracted.

    Raises:
        InputError: The recording has no times and the motion needs them, or they lie outside its
            log.
    """
    check_times(recording.path, motion, is_timed=recording.is_timed)
    begin, end = recording.span
    if begin < end:
        times = np.linspace(begin, end, _PROBES)
        motion.follow(times, np.arange(_PROBES, dtype=float))


def check_times(recording: object, motion: AbstractMotion, *, is_timed: bool) -> None:
    """Refuse a motion that needs times where the recording has none."""
    if motion.needs_times and not is_timed:
        raise InputError(
            f"{recording} has no times, and the motion needs them: give --fps, or a times.csv in "
            "the folder, or say with --step-mm how far the camera moves from picture to picture."
        )
