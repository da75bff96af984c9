"""Gather what the report of a merged scan says."""

import shlex
from collections.abc import Sequence
from itertools import combinations
from pathlib import PurePosixPath

import numpy as np

from ..geometry.disagreement import find_disagreement
from ..geometry.surface_points import nearest_in_cloud
from ..optics.merged_errors import MergedErrors
from ..project import CLOUD, MESH, STAGES, PassRecord, PassResult, Project
from ..project.merged import load_merged_errors, load_pass_rig, load_passes, rig_key
from ..project.unstated import list_unstated
from ..report import (
    MergedSummary,
    ModelSize,
    ReportedPair,
    ReportedPass,
    ReportedRig,
    Shown,
    Trust,
    judge_trust,
    measure_cloud,
    read_steps,
)
from ..types.arrays import Indices
from ..types.cloud import PointCloud
from .recorded import list_commands
from .shown import choose_points

_COMPARED = 2_000_000
"""Points of all passes, about, that their disagreement is looked for in."""
_TRUSTED = 5000
"""Points that stand for all in what rigs and alignments make uncertain."""


def summarise_merged(project: Project, pictures: list[Shown]) -> MergedSummary:
    """Compute all numbers of the report of a merged scan.

    Args:
        project: A merged scan with all stages up to view finished.
        pictures: What to show, the best first.

    Raises:
        MissingResult: A stage has not been finished.
    """
    records, merged = load_passes(project), project.finished(CLOUD).result
    mesh, errors = project.finished(MESH).result, load_merged_errors(project)
    stages = {kind.word: project.finished(kind) for kind in STAGES[2:-1]}
    some = choose_points(project, _COMPARED)
    owner = merged.number_passes(some.frame)
    keys = [rig_key(one) if one.scan is not None and one.scan.rig else "" for one in records]
    rigs = {key: _describe_rig(project, one) for key, one in zip(keys, records, strict=True) if key}
    numbers = {key: number for number, key in enumerate(rigs)}
    model, _ = measure_cloud(
        project.iterate_cloud(), 0, (mesh.vertices, mesh.faces), is_stated=errors.is_stated
    )
    return MergedSummary(
        name=project.root.resolve().name,
        passes=[
            _describe_pass(record, told, numbers.get(key))
            for record, told, key in zip(records, merged.passes, keys, strict=True)
        ],
        pairs=_compare_passes(some, owner, len(records), errors),
        rigs=list(rigs.values()),
        model=model,
        trust=_trust(some, owner, model, errors),
        settings={word: stage.record.key.settings for word, stage in stages.items()},
        versions=project.load_scan().versions,
        durations={word: stage.record.seconds for word, stage in stages.items()},
        commands=[*_list_commands(records), *list_commands(project)],
        pictures=pictures,
        unstated=list_unstated(project),
        remarks=merged.remarks,
    )


def _list_commands(records: Sequence[PassRecord]) -> list[str]:
    """List what made the passes, from wherever it was typed."""
    typed = [one.scan.command for one in records if one.scan is not None and one.scan.command]
    return [shlex.join(["murkscan", *words]) for words in dict.fromkeys(typed)]


def _describe_pass(record: PassRecord, told: PassResult, rig: int | None) -> ReportedPass:
    moved = told.alignment
    return ReportedPass(
        name=PurePosixPath(record.path).name,
        path=record.path,
        points=told.points,
        frames=told.frames,
        first_frame=told.first_frame,
        words=told.words,
        shift=None if moved is None else moved.shift_of_centre,
        turn=None if moved is None else moved.turn,
        overlap=None if moved is None else moved.overlap,
        rms=None if moved is None else moved.rms,
        rig=rig,
        laid_on=told.laid_on,
        correction=told.correction,
        corrected=told.corrected,
    )


def _describe_rig(project: Project, one: PassRecord) -> ReportedRig:
    rig, scan = load_pass_rig(project, one), one.scan
    assert rig is not None
    assert scan is not None
    written = None if scan.recording is None else scan.recording.written
    steps = read_steps(scan.calibration or {}, recorded=None if written is None else written.date())
    return ReportedRig(rig, scan.rig_file, scan.calibration, steps)


def _compare_passes(
    cloud: PointCloud, owner: Indices, count: int, errors: MergedErrors
) -> list[ReportedPair]:
    """Find the pairs of passes that saw the same surface, and how far they lie apart."""
    parts = [cloud[owner == number] for number in range(count)]
    pairs = []
    for first, second in combinations(range(count), 2):
        found = find_disagreement(parts[first], parts[second])
        if found is None:
            continue
        stated = None
        if errors.is_stated:
            ours, theirs = (
                errors.shifts(np.full(len(found.points), number), parts[number][near])
                for number in (first, second)
                for near in (nearest_in_cloud(parts[number], found.points),)
            )
            apart = np.einsum("nj,njm->nm", found.normals, ours - theirs)
            stated = float(np.linalg.norm(apart.mean(axis=0)))
        pairs.append(
            ReportedPair(first, second, found.share, found.mean, found.rms, found.within_95, stated)
        )
    return pairs


def _trust(
    cloud: PointCloud, owner: Indices, model: ModelSize, errors: MergedErrors
) -> Trust | None:
    """Tell how far to trust the points, by what their rigs and alignments share."""
    if not model.points:
        return None
    step = max(len(cloud) // _TRUSTED, 1)
    some = cloud[::step]
    shifts = errors.shifts(owner[::step], some)
    largest = np.linalg.eigvalsh(shifts @ shifts.transpose(0, 2, 1))[:, -1]
    common = np.sqrt(np.maximum(largest, 0.0))
    return judge_trust(some.sigma, common, is_stated=errors.is_stated)
