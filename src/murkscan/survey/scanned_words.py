"""How a scan was made, in words: with which rig, in which water, how fast, when."""

from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import numpy as np

from ..errors import MurkscanError
from ..project import EXTRACT, MOTION, Project, ScanRecord, is_merged, load_scan_rig
from ..project.merged import load_passes
from ..project.origin import name_recording
from ..report import read_steps
from ..report.words import rig_rows
from .recorded import when_began

_ENDS = (1.0, 99.0)
"""Percent of the points between which the distances lie that are told."""


def tell_how_scanned(project: Project) -> list[tuple[str, str]]:
    """Say what a sheet that is signed has to say of a scan, or of the passes of a merged cloud.

    Returns:
        What, and how; of passes that differ all, parted by semicolons.
    """
    told: dict[str, list[str]] = {}
    for one in _list_scans(project):
        for name, words in _tell(one):
            told.setdefault(name, []).append(words)
    rows = [(name, "; ".join(dict.fromkeys(words))) for name, words in told.items()]
    if is_merged(project):
        rows.insert(0, ("passes", ", ".join(one.path for one in load_passes(project))))
    return rows


def _list_scans(project: Project) -> Iterator[Project]:
    """List the scan itself, or those passes of a merged cloud that still lie where they lay."""
    if not is_merged(project):
        yield project
        return
    for one in load_passes(project):
        if (project.root / one.path / "scan.json").exists():
            yield Project(project.root / one.path)


def _tell(project: Project) -> Iterator[tuple[str, str]]:
    scan, motion = project.load_scan(), project.finished(MOTION).result
    recording = scan.recording
    assert recording is not None
    began = when_began(project.load_frame_times(), motion.start) or recording.written
    day = "on a day not known" if began is None else f"of {began:%Y-%m-%d}"
    yield "recording", f"{name_recording(Path(recording.path))} {day} ({recording.path})"
    yield "rig", _tell_rig(scan)
    yield "water", f"{dict(rig_rows(load_scan_rig(project)))['water']}; {_tell_murk(project)}"
    is_timed = recording.is_timed and motion.duration > 0
    speed = f"{1e3 * motion.length / motion.duration:.0f} mm/s" if is_timed else "not known"
    yield "speed", f"{speed}, over {1e3 * motion.length:.0f} mm, {_tell_distance(project)}"
    extractor = scan.settings.get("extractor", {}).get("type", "extractor not known")
    made = "" if scan.started is None else f" on {scan.started:%Y-%m-%d}"
    version = scan.versions.get("murkscan", "of a version not known")
    yield "scanned", f"by murkscan {version}, {extractor}{made}"


def _tell_rig(scan: ScanRecord) -> str:
    written = None if scan.recording is None else scan.recording.written
    steps = read_steps(scan.calibration or {}, recorded=written.date() if written else None)
    made = [f"{step.name} {step.date:%Y-%m-%d}" for step in steps if step.date is not None]
    told = f"calibrated: {', '.join(made)}" if made else "no calibration recorded"
    return f"{scan.rig_file or 'file not known'}, {told}"


def _tell_murk(project: Project) -> str:
    found = None
    with suppress(MurkscanError):
        found = project.finished(EXTRACT).result.attenuation
    if found is None:
        return "how murky, the recording does not tell"
    return f"beam attenuation between {found.low:.2g} and {found.high:.2g} per metre, by the glow"


def _tell_distance(project: Project) -> str:
    depths = np.concatenate([part.points[:, 2] for part in project.load_kept_parts()])
    near, far = np.percentile(depths, _ENDS) if len(depths) else (np.nan, np.nan)
    return f"{near:.2f} to {far:.2f} m away"
