"""What scan.json and the stages say of the recording and of how it was scanned, for the report."""

import shlex
from datetime import UTC, datetime
from pathlib import Path

from ..project import EXTRACT, MOTION, STAGES, Project, ScanRecord, is_merged, load_recording
from ..project.origin import name_recording
from ..project.unstated import list_unstated
from ..report import Recorded
from ..types.frame_times import FrameTimes

_SINCE = 1e8
"""A log's time above this counts seconds since 1970; below it, a clock of its own [s]."""


def tell_recording(project: Project, scan: ScanRecord) -> Recorded:
    """Gather what is known of the recording.

    Args:
        project: A scan with all stages up to view finished.
        scan: Its scan.json.
    """
    recording, extracted = load_recording(project), project.finished(EXTRACT).result
    motion = project.finished(MOTION).result
    return Recorded(
        name=name_recording(Path(recording.path)),
        size=recording.size,
        fields_per_picture=recording.fields_per_picture,
        is_timed=recording.is_timed,
        skips=list(extracted.skips),
        remarks=(*extracted.remarks, *motion.remarks),
        motion=motion.accuracy,
        correction=motion.correction,
        unstated=list_unstated(project),
        attenuation=extracted.attenuation,
        path=recording.path,
        began=when_began(project.load_frame_times(), motion.start),
        written=recording.written,
        scanned=scan.started,
        rig_file=scan.rig_file,
        calibration=scan.calibration,
        commands=list_commands(project),
    )


def when_began(frames: FrameTimes, start: float) -> datetime | None:
    """Tell when the first frame was taken, where the log of the poses counts from 1970.

    Args:
        frames: The frames that were read.
        start: What the log's clock showed when recording time was 0 [s].
    """
    if not len(frames) or not start + frames.time[0] > _SINCE:
        return None
    try:
        return datetime.fromtimestamp(start + float(frames.time[0]), UTC)
    except (OverflowError, ValueError, OSError):  # a clock that counts something else
        return None


def list_commands(project: Project) -> list[str]:
    """List the commands that made the stages, in order; none of what was run from Python."""
    made = STAGES[2:-1] if is_merged(project) else STAGES[:-1]
    typed = [project.finished(kind).record.command for kind in made]
    typed.append(tuple(project.command))
    return [shlex.join(["murkscan", *words]) for words in dict.fromkeys(typed) if words]
