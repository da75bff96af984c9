"""The passes of a merged cloud: their rigs, and the errors that their points share."""

import numpy as np

from ..errors import MissingResult
from ..io.rig_toml import parse_rig
from ..optics.merged_errors import Answer, MergedErrors, SeenPass
from ..types.rig import Rig
from .describe import digest
from .folder import Project
from .kinds import CLOUD, MOTION
from .results import PassRecord, PassResult
from .scanned import as_it_moves


def load_passes(project: Project) -> tuple[PassRecord, ...]:
    """Read the passes of a merged cloud.

    Raises:
        MissingResult: It was merged by a version that kept too little of them.
    """
    passes = project.load_scan().passes
    if not passes:
        raise MissingResult(
            f"{project.root} was merged by an earlier version of murkscan, which kept nothing of "
            "its passes' rigs; run `murkscan merge` again."
        )
    return passes


def load_pass_rig(project: Project, one: PassRecord) -> Rig | None:
    """Read the rig of a pass as it moved; None for a cloud of another program."""
    if one.scan is None or not one.scan.rig:
        return None
    rig = parse_rig(dict(one.scan.rig), name=f"{project.root / 'scan.json'}: rig of {one.path}")
    return as_it_moves(rig, carries_mount=one.carries_mount)


def list_unstated(project: Project) -> list[str]:
    """Name the passes of which no rig with a covariance is known."""
    rigs = [(one.path, load_pass_rig(project, one)) for one in load_passes(project)]
    return [path for path, rig in rigs if rig is None or not rig.covariance.names]


def load_merged_errors(project: Project) -> MergedErrors:
    """Read how the points of a merged cloud move with the errors of its rigs and alignments.

    Raises:
        MissingResult: A stage has not been finished, or the cloud is of an earlier version.
        FormatError: A rig or the poses are damaged.
    """
    records, told = load_passes(project), project.finished(CLOUD).result.passes
    trajectory = project.load_trajectory() if project.finished(MOTION).result.poses else None
    seen: list[SeenPass | None] = []
    for record, one in zip(records, told, strict=True):
        rig, times = load_pass_rig(project, record), np.array(one.frames[:1], float)
        if rig is None or trajectory is None or not trajectory.has(times).all():
            seen.append(None)
        else:
            seen.append(SeenPass(rig, trajectory, rig_key(record)))
    return MergedErrors(seen, [_answer(one) for one in told])


def rig_key(record: PassRecord) -> str:
    """Give a short text that is the same for passes of the same rig, in whatever water."""
    assert record.scan is not None
    rig = {name: table for name, table in record.scan.rig.items() if name != "water"}
    return digest([rig, record.carries_mount])


def _answer(told: PassResult) -> Answer | None:
    if told.alignment is None:
        return None
    return Answer(np.array(told.alignment.centre), np.array(told.answers))
