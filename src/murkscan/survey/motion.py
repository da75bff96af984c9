"""Where the camera was in each frame of a scan."""

import numpy as np

from ..capture import AbstractRecording
from ..errors import InputError
from ..motion import AbstractMotion
from ..project import (
    EXTRACT,
    MOTION,
    TRIANGULATE,
    MotionResult,
    Project,
    describe,
    load_recording,
)
from ..types.trajectory import Trajectory
from .corrected import Corrected, is_correctable
from .progress import Progress, silent
from .stage_runner import run_stage


def follow_motion(
    project: Project, motion: AbstractMotion, *, adjust: bool = True, progress: Progress = silent
) -> MotionResult:
    """Run the motion stage: what is logged, corrected by what the scan saw of the same places.

    Args:
        project: A scan with a finished extract stage, and triangulate where it is corrected.
        motion: How the camera moved.
        adjust: Whether the scan corrects a motion whose accuracy is stated.
        progress: Told when it begins and ends.

    Raises:
        MissingResult: A stage before it has not been finished.
        InputError: The recording has no times and the motion needs them, or they lie outside its
            log.
    """
    settings = {"motion": describe(motion), "adjust": adjust}
    inputs = {"extract": project.finished(EXTRACT).digest}
    is_adjusted = adjust and is_correctable(motion, project.finished(EXTRACT).result.lasers)
    if is_adjusted:
        inputs["triangulate"] = project.finished(TRIANGULATE).digest
    stage = project.stage(MOTION, settings=settings, inputs=inputs)
    times = project.load_frame_times()

    def prepare() -> tuple[Trajectory, Corrected]:
        recording = load_recording(project)
        check_times(recording.path, motion, is_timed=recording.is_timed)
        pictures = times.frame.astype(float) / recording.fields_per_picture
        logged = motion.follow(times.time, pictures)
        if not is_adjusted:
            return logged, Corrected(logged)
        from .correct import correct  # loaded when due: few scans correct anything

        return logged, correct(project, motion, logged)

    def make(found: tuple[Trajectory, Corrected]) -> MotionResult:
        logged, corrected = found
        trajectory = corrected.trajectory
        project.save_trajectory(trajectory, logged=logged)
        if (measured := motion.measure()) is not None:
            project.save_measured(measured)
        steps = np.linalg.norm(np.diff(trajectory.positions, axis=0), axis=1)
        return MotionResult(
            poses=len(trajectory.times),
            frames_without_pose=len(times) - len(trajectory.times),
            duration=float(np.ptp(times.time)),
            length=float(steps.sum()),
            remarks=motion.remarks(times.time),
            accuracy="" if trajectory.errors is None else corrected.accuracy or motion.accuracy,
            carries_mount=motion.carries_mount,
            start=motion.start,
            correction=corrected.words,
            corrected=corrected.moved,
        )

    return run_stage(project, stage, make, prepare=prepare, progress=progress)


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
