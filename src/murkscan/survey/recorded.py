"""What scan.json and the stages say of the recording and of how it was scanned, for the report."""

import shlex
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from ..project import Project
from ..report import Recorded
from ..types.background import Attenuation
from ..types.frame_times import FrameTimes
from .origin import name_recording

_SINCE = 1e8
"""A log's time above this counts seconds since 1970; below it, a clock of its own [s]."""


def tell_recording(project: Project, scan: dict[str, Any]) -> Recorded:
    """Gather what is known of the recording.

    Args:
        project: A scan with all stages up to view finished.
        scan: Its scan.json.
    """
    recording, counts = scan["recording"], project.finished("extract").counts()
    moved = project.finished("motion")
    motion, odd = moved.key["settings"]["motion"], moved.counts().get("remarks", [])
    return Recorded(
        name=name_recording(Path(recording["path"])),
        size=tuple(recording["size"]),
        fields_per_picture=recording["fields_per_picture"],
        is_timed=recording["is_timed"],
        skips=[tuple(skip) for skip in counts["skips"]],
        remarks=[*counts.get("remarks", []), *odd],
        attenuation=attenuation_of(counts),
        path=recording["path"],
        began=when_began(project.load_frame_times(), motion),
        written=_moment(recording.get("written")),
        scanned=_moment(scan.get("started")),
        rig_file=scan.get("rig_file", ""),
        calibration=scan.get("calibration"),
        commands=commands_of(str(project.root), scan.get("command", ()), motion),
    )


def attenuation_of(extracted: dict[str, Any]) -> Attenuation | None:
    """Read how murky the water was from what the extract stage said."""
    water = extracted.get("attenuation")
    return water and Attenuation(water["effective_per_m"], *water["between_per_m"])


def when_began(frames: FrameTimes, motion: dict[str, Any]) -> datetime | None:
    """Give when the first frame was taken, where the log of the poses counts from 1970.

    Args:
        frames: The frames that were read.
        motion: The settings of the motion.
    """
    start = motion.get("start_time", 0.0) + motion.get("time_offset", 0.0)
    if not len(frames) or not start + frames.time[0] > _SINCE:
        return None
    try:
        return datetime.fromtimestamp(start + float(frames.time[0]), UTC)
    except (OverflowError, ValueError, OSError):  # a clock that counts something else
        return None


def _moment(text: str | None) -> datetime | None:
    return None if text is None else datetime.fromisoformat(text)


def commands_of(out: str, typed: Sequence[str], motion: dict[str, Any]) -> list[str]:
    """Give what was typed; of stages that were run one by one, what does the same.

    Args:
        out: The scan's folder.
        typed: The words of the command that began the scan, after `murkscan`; none from Python.
        motion: The settings of the motion.
    """
    if not typed:
        return []
    lines = [shlex.join(["murkscan", *typed])]
    if typed[0] == "extract":
        stages = ("triangulate", "motion", "cloud", "mesh", "view", "report")
        flags = {"motion": f" {_motion_flags(motion)}"}
        lines += [f"murkscan {name} {shlex.quote(out)}{flags.get(name, '')}" for name in stages]
    return lines


def _motion_flags(motion: dict[str, Any]) -> str:
    """Write a motion's settings as the flags of `murkscan motion`."""
    if motion["type"] == "ConstantSpeed":
        return f"--speed-mm-s {1e3 * motion['speed']:.9g} --along {motion['along']}"
    if motion["type"] == "ConstantStep":
        return f"--step-mm {1e3 * motion['step']:.9g} --along {motion['along']}"
    clock = f"--start-time {motion['start_time']!r} --time-offset-s {motion['time_offset']!r}"
    return f"--poses {shlex.quote(motion['name'])} {clock}"
