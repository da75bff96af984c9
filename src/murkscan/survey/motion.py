"""Where the camera was in each frame of a scan."""

import numpy as np

from ..capture import AbstractRecording
from ..errors import InputError
from ..motion import AbstractMotion
from ..project import EXTRACT, MOTION, MotionResult, Project, describe, load_recording
from ..types.trajectory import Trajectory
from .progress import silent
from .stage_runner import run_stage


def follow_motion(project: Project, motion: AbstractMotion) -> MotionResult:
    """Run the motion stage.

    Raises:
        MissingResult: The extract stage has not been finished.
        InputError: The recording has no times and the motion needs them, or they lie outside its
            log.
    """
    stage = project.stage(
        MOTION,
        settings={"motion": describe(motion)},
        inputs={"extract": project.finished(EXTRACT).digest},
    )

    times = project.load_frame_times()

    def prepare() -> Trajectory:
        recording = load_recording(project)
        check_times(recording.path, motion, is_timed=recording.is_timed)
        pictures = times.frame.astype(float) / recording.fields_per_picture
        return motion.follow(times.time, pictures)

    def make(trajectory: Trajectory) -> MotionResult:
        project.save_trajectory(trajectory)
        steps = np.linalg.norm(np.diff(trajectory.positions, axis=0), axis=1)
        return MotionResult(
            poses=len(trajectory.times),
            frames_without_pose=len(times) - len(trajectory.times),
            duration=float(np.ptp(times.time)),
            length=float(steps.sum()),
            remarks=motion.remarks(times.time),
            accuracy="" if trajectory.errors is None else motion.accuracy,
            carries_mount=motion.carries_mount,
            start=motion.start,
        )

    return run_stage(project, stage, make, prepare=prepare, progress=silent)


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
