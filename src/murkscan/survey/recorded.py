"""What scan.json and the stages say of the recording and of how it was scanned, for the report."""

import shlex
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from ..project import Project
from ..report import Recorded
from ..types.background import Attenuation

_SINCE = 1e8
"""A log's time above this counts seconds since 1970; below it, a clock of its own [s]."""


def tell_recording(project: Project, scan: dict[str, Any]) -> Recorded:
    """Gather what is known of the recording.

    Args:
        project: A scan with all stages up to view finished.
        scan: Its scan.json.
    """
    recording, counts = scan["recording"], project.finished("extract").counts()
    motion = project.finished("motion").key["settings"]["motion"]
    return Recorded(
        name=Path(recording["path"]).name,
        size=tuple(recording["size"]),
        fields_per_picture=recording["fields_per_picture"],
        is_timed=recording["is_timed"],
        skips=[tuple(skip) for skip in counts["skips"]],
        remarks=counts.get("remarks", []),
        attenuation=_attenuation(counts),
        path=recording["path"],
        began=_began(project, motion),
        written=_moment(recording.get("written")),
        scanned=_moment(scan.get("started")),
        rig_file=scan.get("rig_file", ""),
        calibration=scan.get("calibration"),
        commands=_commands(project, scan, motion),
    )


def _attenuation(extracted: dict[str, Any]) -> Attenuation | None:
    water = extracted.get("attenuation")
    return water and Attenuation(water["effective_per_m"], *water["between_per_m"])


def _began(project: Project, motion: dict[str, Any]) -> datetime | None:
    """Give when the first frame was taken, where the log of the poses counts from 1970."""
    start = motion.get("start_time", 0.0) + motion.get("time_offset", 0.0)
    times = project.load_frame_times().time
    if not len(times) or not start + times[0] > _SINCE:
        return None
    return datetime.fromtimestamp(start + float(times[0]), UTC)


def _moment(text: str | None) -> datetime | None:
    return None if text is None else datetime.fromisoformat(text)


def _commands(project: Project, scan: dict[str, Any], motion: dict[str, Any]) -> list[str]:
    """Give what was typed; of stages that were run one by one, what says the same."""
    typed = scan.get("command")
    if not typed:
        return []
    lines = [shlex.join(["murkscan", *typed])]
    if typed[0] == "extract":
        out = shlex.quote(str(project.root))
        stages = ("triangulate", "motion", "cloud", "mesh", "view", "report")
        flags = {"motion": f" {_motion_flags(motion)}"}
        lines += [f"murkscan {stage} {out}{flags.get(stage, '')}" for stage in stages]
    return lines


def _motion_flags(motion: dict[str, Any]) -> str:
    """Write a motion's settings as the flags of `murkscan motion`."""
    if motion["type"] == "ConstantSpeed":
        return f"--speed-mm-s {1e3 * motion['speed']:.9g} --along {motion['along']}"
    if motion["type"] == "ConstantStep":
        return f"--step-mm {1e3 * motion['step']:.9g} --along {motion['along']}"
    clock = f"--start-time {motion['start_time']!r} --time-offset-s {motion['time_offset']!r}"
    return f"--poses {shlex.quote(motion['name'])} {clock}"
