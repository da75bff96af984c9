"""The passes of a merged cloud: their rigs, and the errors that their points share."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..errors import FormatError, MissingResult
from ..io.rig_toml import parse_rig
from ..optics.merged_errors import Answer, MergedErrors, SeenPass
from ..types.rig import Rig
from ..types.trajectory import Trajectory
from .describe import digest
from .folder import Project
from .kinds import CLOUD, MOTION
from .results import PassResult
from .scan_record import PassRecord
from .scanned import as_it_moves


def load_passes(project: Project) -> tuple[PassRecord, ...]:
    """Read the passes of a merged cloud.

    Raises:
        MissingResult: It was merged by a version that kept too little of them, or another merge
            was begun in its folder.
    """
    passes = project.load_scan().passes
    if not passes:
        raise MissingResult(
            f"{project.root} was merged by an earlier version of murkscan, which kept nothing of "
            "its passes' rigs; run `murkscan merge` again."
        )
    made_of = project.finished(CLOUD).record.key.inputs.get("passes")
    if made_of != [one.identity for one in passes]:
        raise MissingResult(
            f"A merge of other passes was begun in {project.root} and not finished; run "
            "`murkscan merge` again."
        )
    return passes


def load_pass_rig(project: Project, one: PassRecord) -> Rig | None:
    """Read the rig of a pass as it moved; None for a cloud of another program."""
    if one.scan is None or not one.scan.rig:
        return None
    rig = parse_rig(dict(one.scan.rig), name=f"{project.root / 'scan.json'}: rig of {one.path}")
    return as_it_moves(rig, carries_mount=one.carries_mount)


def load_merged_errors(project: Project) -> MergedErrors:
    """Read how the points of a merged cloud move with all errors that are stated.

    They are those of its passes' rigs and poses, and of their alignments.

    Raises:
        MissingResult: A stage has not been finished, or the cloud is of an earlier version.
        FormatError: A rig, the poses or the record are damaged.
    """
    records, told = load_passes(project), _load_told(project)
    is_joint = project.finished(CLOUD).result.is_joint
    trajectory = project.load_trajectory() if project.finished(MOTION).result.poses else None
    seen, first = list[SeenPass | None](), 0
    for record, one in zip(records, told, strict=True):
        rig, own = load_pass_rig(project, record), _part_of(trajectory, one, first)
        if rig is None or own is None:
            seen.append(None)
        else:
            seen.append(SeenPass(rig, own, rig_key(record)))
        first += 0 if is_joint else one.pose_errors
    errors = MergedErrors.of_passes(seen, is_joint=is_joint)
    answers = [_read_answer(project, one, len(errors.basis)) for one in told]
    return replace(errors, answers=answers)


def _load_told(project: Project) -> Sequence[PassResult]:
    """Read what became of each pass, one for each."""
    told = project.finished(CLOUD).result.passes
    if len(told) != len(load_passes(project)):
        raise _damaged(project)
    return told


def _damaged(project: Project) -> FormatError:
    return FormatError(
        f"{project.root / 'cloud' / 'stage.json'} is damaged: what it says of the passes is not of "
        "them. Delete it and run `murkscan merge` again."
    )


def _part_of(trajectory: Trajectory | None, one: PassResult, first: int) -> Trajectory | None:
    """Take the poses of a pass out of those of all; its errors begin with the `first`."""
    if trajectory is None:
        return None
    mine = (trajectory.times >= one.frames[0]) & (trajectory.times <= one.frames[1])
    if not mine.any():
        return None
    return Trajectory(
        trajectory.times[mine],
        trajectory.positions[mine],
        trajectory.quaternions[mine],
        None
        if trajectory.errors is None
        else trajectory.errors[mine][:, :, first : first + one.pose_errors],
    )


def rig_key(record: PassRecord) -> str:
    """Give a short text that is the same for passes of the same rig, in whatever water."""
    assert record.scan is not None
    rig = {name: table for name, table in record.scan.rig.items() if name != "water"}
    return digest([rig, record.carries_mount])


def _read_answer(project: Project, told: PassResult, count: int) -> Answer | None:
    """Read how a pass moves with each of so many parameters; None for one that stays."""
    if told.alignment is None:
        return None
    if [len(row) for row in told.answers] != 6 * [count] or len(told.alignment.centre) != 3:
        raise _damaged(project)
    return Answer(np.array(told.alignment.centre), np.array(told.answers))
