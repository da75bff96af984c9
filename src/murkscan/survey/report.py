"""Tell how a scan went: one page for people, one file for programs."""

import math
from collections.abc import Sequence
from dataclasses import replace

from ..errors import InputError
from ..io.values import as_plain
from ..project import (
    CLOUD,
    EXTRACT,
    MESH,
    REPORT,
    STAGES,
    VIEW,
    Project,
    ReportResult,
    digest,
    is_merged,
    load_scan_rig,
)
from ..report import (
    AT_95,
    NO_HEADING,
    CalibrationStep,
    Heading,
    MergedSummary,
    ScanSummary,
    Shown,
    as_html,
    as_json,
    merged_as_html,
    merged_as_json,
    summarise,
    with_coverage,
)
from ..view import PICTURES
from .merged_report import summarise_merged
from .progress import Progress, silent
from .recorded import tell_recording
from .reported import digest_beside, tell_beside
from .stage_runner import run_stage


def write_report(
    project: Project,
    *,
    spacing: float | None = None,
    heading: Heading = NO_HEADING,
    progress: Progress = silent,
) -> ReportResult:
    """Run the report stage, from what the other stages have left.

    Args:
        project: A scan with all stages up to view finished.
        spacing: Wanted spacing of the points [m]; gaps are judged by the scan's own unless given.
        heading: What the page is called, and for whom and where the scan was made.
        progress: Told when it begins and ends.

    Raises:
        InputError: The spacing is not above 0, or is given for a cloud that was merged from others.
        MissingResult: The view stage has not been finished.
        DeviceError: The disk is full.
    """
    if spacing is not None and is_merged(project):
        raise InputError(
            f"{project.root} was merged from other scans, whose own reports judge gaps and speed; "
            "give --spacing-mm to `murkscan report` on each of those."
        )
    if spacing is not None and not 0 < spacing < math.inf:
        raise InputError(f"The wanted spacing must be above 0 mm, got {1e3 * spacing:g} mm.")
    told = replace(project.load_scan(), started=None)
    inputs = {"view": project.finished(VIEW).digest, "scan": digest(as_plain(told))}
    inputs |= digest_beside(project)
    said = {key: word for key, word in heading.as_plain().items() if word}
    stage = project.stage(REPORT, settings={"spacing": spacing} | said, inputs=inputs)

    def make(summary: ScanSummary | MergedSummary) -> ReportResult:
        if isinstance(summary, MergedSummary):
            project.save_report(merged_as_json(summary, heading), merged_as_html(summary, heading))
            return _merged_in_short(summary)
        project.save_report(as_json(summary, heading), as_html(summary, heading))
        return _in_short(summary)

    def prepare() -> ScanSummary | MergedSummary:
        if is_merged(project):
            merged = summarise_merged(project, _pictures(project))
            return replace(merged, model=tell_beside(project, merged.model))
        summary = _summarise(project, spacing)
        return replace(summary, model=tell_beside(project, summary.model))

    return run_stage(project, stage, make, prepare=prepare, progress=progress)


def _in_short(summary: ScanSummary) -> ReportResult:
    coverage, trust = summary.coverage, summary.trust
    missing = {} if coverage is None else coverage.missing
    worst = max(missing, key=lambda cause: missing[cause], default=None)
    typical, own = (None, None) if trust is None else (trust.total.median, trust.independent.median)
    return ReportResult(
        frames=summary.num_frames,
        skipped=summary.recorded.num_skipped,
        frames_without_stripe=summary.num_empty,
        points=summary.num_points,
        covered=None if coverage is None else coverage.covered / coverage.mapped,
        largest_gap=None if worst is None or not missing[worst] else worst,
        half_width=None if typical is None else AT_95 * typical,
        own_half_width=None if own is None else AT_95 * own,
        unstated=tuple(summary.recorded.unstated),
        steps_with_advice=_with_advice(summary.steps),
    )


def _merged_in_short(summary: MergedSummary) -> ReportResult:
    trust, steps = summary.trust, [step for one in summary.rigs for step in one.steps]
    typical, own = (None, None) if trust is None else (trust.total.median, trust.independent.median)
    return ReportResult(
        frames=sum(one.frames[1] - one.frames[0] + 1 for one in summary.passes),
        skipped=0,
        frames_without_stripe=0,
        points=summary.model.points,
        half_width=None if typical is None else AT_95 * typical,
        own_half_width=None if own is None else AT_95 * own,
        unstated=tuple(summary.unstated),
        steps_with_advice=_with_advice(steps),
    )


def _with_advice(steps: Sequence[CalibrationStep]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(one.name for one in steps if one.verdict and not one.is_good))


def _summarise(project: Project, spacing: float | None) -> ScanSummary:
    scan, stages = project.load_scan(), {kind.word: project.finished(kind) for kind in STAGES[:-1]}
    frames, trajectory = project.load_placed_times(), project.load_trajectory()
    lasers, mesh = project.finished(EXTRACT).result.lasers, project.finished(MESH).result
    background = project.load_background(lasers[0])
    summary = summarise(
        tell_recording(project, scan),
        load_scan_rig(project),
        project.load_placed_parts(),
        frames=frames,
        lasers=lasers,
        trajectory=trajectory,
        cloud=project.iterate_cloud(),
        num_outliers=project.finished(CLOUD).result.outliers,
        mesh_size=(mesh.vertices, mesh.faces),
        wanted=spacing,
        noise=0.0 if background is None else background.noise,
        settings={word: stage.record.key.settings for word, stage in stages.items()},
        versions=scan.versions,
        durations={word: stage.record.seconds for word, stage in stages.items()},
        pictures=_pictures(project),
    )
    kept = project.load_kept_parts()
    return with_coverage(summary, kept, frames=frames, trajectory=trajectory)


def _pictures(project: Project) -> list[Shown]:
    views = [
        Shown(f"../view/{name}.png", PICTURES.get(name, name))
        for name in project.finished(VIEW).result.pictures
    ]
    found = [  # none where passes were merged
        Shown(f"../extract/overlay/{name}.png", _caption(name), is_frame=True)
        for name in project.find_overlays()
    ]
    return views + found


def _caption(overlay: str) -> str:
    frame, _, poor = overlay.partition("_")
    return f"what was found in frame {int(frame)}{', one of the poorest' if poor else ''}"
