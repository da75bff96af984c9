"""Tell how a scan went: one page for people, one file for programs."""

import hashlib
import json
import math
import time
from typing import Any

from ..errors import InputError
from ..io.json_files import load_json
from ..project import STAGES, Project
from ..report import ScanSummary, Shown, as_html, as_json, summarise, with_coverage
from .kept import kept_profiles
from .merged import require_recording
from .progress import Progress, silent
from .recorded import tell_recording
from .scan_rig import load_scan_rig


def write_report(
    project: Project, *, spacing: float | None = None, progress: Progress = silent
) -> dict[str, Any]:
    """Run the report stage, from what the other stages have left.

    Args:
        project: A scan with all stages up to view finished.
        spacing: Wanted spacing of the points [m]; gaps are judged by the scan's own unless given.
        progress: Told when it begins and ends.

    Returns:
        Counts: frames, skipped, frames_without_stripe, points.

    Raises:
        InputError: The spacing is not above 0, or the cloud was merged from other scans.
        MissingResult: The view stage has not been finished.
        DeviceError: The disk is full.
    """
    require_recording(project)
    if spacing is not None and not 0 < spacing < math.inf:
        raise InputError(f"The wanted spacing must be above 0 mm, got {1e3 * spacing:g} mm.")
    stage = project.stage(
        "report",
        settings={"spacing": spacing},
        inputs={"view": project.finished("view").digest, "scan": _digest(project.load_scan())},
    )
    if (result := stage.result()) is not None:
        return result
    since = time.monotonic()
    progress("report", 0, None)
    summary = _summarise(project, spacing)
    stage.begin()
    project.save_report(as_json(summary), as_html(summary))
    result = {
        "frames": summary.num_frames,
        "skipped": summary.recorded.num_skipped,
        "frames_without_stripe": summary.num_empty,
        "points": summary.num_points,
    }
    stage.finish(result, since=since)
    progress("report", 1, 1)
    return result


def _digest(scan: dict[str, Any]) -> str:
    """Give a text that changes with what scan.json says, but for when it was said."""
    told = {name: value for name, value in scan.items() if name != "started"}
    return hashlib.sha256(json.dumps(told, sort_keys=True).encode()).hexdigest()[:16]


def _summarise(project: Project, spacing: float | None) -> ScanSummary:
    scan, extract = project.load_scan(), project.finished("extract")
    stages = {name: project.finished(name) for name in STAGES if name != "report"}
    frames, trajectory = project.load_placed_times(), project.load_trajectory()
    mesh = stages["mesh"].counts()
    summary = summarise(
        tell_recording(project, scan),
        load_scan_rig(project),
        project.load_placed_parts(),
        frames=frames,
        laser=extract.key["settings"]["laser"],
        trajectory=trajectory,
        cloud=project.iterate_cloud(),
        num_outliers=stages["cloud"].counts()["outliers"],
        mesh_size=(mesh["vertices"], mesh["faces"]),
        wanted=spacing,
        noise=_noise(project),
        settings={name: stage.key["settings"] for name, stage in stages.items()},
        versions=scan["versions"],
        durations={name: stage.seconds() for name, stage in stages.items()},
        pictures=_pictures(project),
    )
    profiles = kept_profiles(project, summary.rig.lasers[summary.laser].axis)
    return with_coverage(summary, profiles, frames=frames, trajectory=trajectory)


def _noise(project: Project) -> float:
    """Give the noise of a pixel that the extractor has learnt [grey levels]; 0 if it kept none."""
    file = project.finished("extract").folder / "background.json"
    return float(load_json(file).get("noise", 0.0)) if file.exists() else 0.0


def _pictures(project: Project) -> list[Shown]:
    views = [
        Shown(f"../view/{name}.png", name.replace("-", ", coloured by "))
        for name in project.finished("view").counts()["pictures"]
    ]
    found = [
        Shown(f"../extract/overlay/{file.name}", _caption(file.stem), is_frame=True)
        for file in project.find_overlays()
    ]
    return views + found


def _caption(overlay: str) -> str:
    frame, _, poor = overlay.partition("_")
    return f"what was found in frame {int(frame)}{', one of the poorest' if poor else ''}"
