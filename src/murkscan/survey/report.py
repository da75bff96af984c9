"""Tell how a scan went: one page for people, one file for programs."""

import time
from pathlib import Path
from typing import Any

from ..project import STAGES, Project
from ..report import Recorded, ScanSummary, Shown, as_html, as_json, summarise
from ..types.background import Attenuation
from .progress import Progress, silent
from .scan_rig import load_scan_rig


def write_report(project: Project, *, progress: Progress = silent) -> dict[str, Any]:
    """Run the report stage, from what the other stages have left.

    Returns:
        Counts: frames, skipped, frames_without_stripe, points.

    Raises:
        MissingResult: The view stage has not been finished.
        DeviceError: The disk is full.
    """
    stage = project.stage("report", settings={}, inputs={"view": project.finished("view").digest})
    if (result := stage.result()) is not None:
        return result
    since = time.monotonic()
    progress("report", 0, None)
    summary = _summarise(project)
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


def _summarise(project: Project) -> ScanSummary:
    scan, extract = project.load_scan(), project.finished("extract")
    stages = {name: project.finished(name) for name in STAGES if name != "report"}
    has_mesh = stages["mesh"].counts()["faces"] > 0
    recording = scan["recording"]
    return summarise(
        Recorded(
            name=Path(recording["path"]).name,
            size=tuple(recording["size"]),
            fields_per_picture=recording["fields_per_picture"],
            is_timed=recording["is_timed"],
            skips=[tuple(skip) for skip in extract.counts()["skips"]],
            remarks=extract.counts().get("remarks", []),
            attenuation=_attenuation(extract.counts()),
        ),
        load_scan_rig(project),
        project.load_profile_parts(),
        frames=project.load_frame_times(),
        laser=extract.key["settings"]["laser"],
        trajectory=project.load_trajectory(),
        cloud=project.load_cloud(),
        num_outliers=stages["cloud"].counts()["outliers"],
        mesh=project.load_mesh() if has_mesh else None,
        settings={name: stage.key["settings"] for name, stage in stages.items()},
        versions=scan["versions"],
        durations={name: stage.seconds() for name, stage in stages.items()},
        pictures=_pictures(project),
    )


def _attenuation(extracted: dict[str, Any]) -> Attenuation | None:
    water = extracted.get("attenuation")
    return water and Attenuation(water["effective_per_m"], *water["between_per_m"])


def _pictures(project: Project) -> list[Shown]:
    views = [
        Shown(f"../view/{name}.png", name.replace("-", ", coloured by "))
        for name in project.finished("view").counts()["pictures"]
    ]
    found = [
        Shown(
            f"../extract/overlay/{file.name}",
            f"what was found in frame {int(file.stem.split('_')[0])}",
        )
        for file in project.find_overlays()
    ]
    return views + found


def _caption(overlay: str) -> str:
    frame, _, poor = overlay.partition("_")
    return f"what was found in frame {int(frame)}{', one of the poorest' if poor else ''}"
