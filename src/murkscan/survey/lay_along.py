"""Adjust passes that registration has laid on one another, each along its whole way."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import count

import numpy as np

from ..errors import MissingResult
from ..geometry.surface_points import nearest_in_cloud
from ..motion.corrected import Correction
from ..motion.together import FEWEST, LaidPass, correct_together
from ..optics.merged_errors import MergedErrors
from ..project import MOTION, TRIANGULATE, Project, is_merged, load_scan_rig
from ..project.passes import NumberedPass
from ..types.cloud import PointCloud
from ..types.trajectory import Trajectory
from .lay_rigidly import Laid
from .progress import Progress


@dataclass(frozen=True, eq=False)
class LaidAlong:
    """Passes that were adjusted together; of each pass one."""

    ways: tuple[Trajectory, ...]
    """world_from_camera, with the merged cloud's frame numbers for times."""
    corrections: tuple[Correction, ...]
    errors: MergedErrors


@dataclass(frozen=True)
class NotAdjusted:
    """That passes stay rigid bodies, and why."""

    words: str


def lay_along(
    passes: Sequence[NumberedPass], laid: Mapping[int, Laid], progress: Progress
) -> LaidAlong | NotAdjusted:
    """Adjust the ways of passes together, as far as the accuracy of their logs is stated.

    Args:
        passes: At least one.
        laid: How each was laid as a rigid body, in the order in which they were.
        progress: Told that it goes on.
    """
    prepared = []
    for number, one in enumerate(passes):
        scanned = _prepare(one, laid[number])
        if isinstance(scanned, NotAdjusted):
            return scanned
        prepared.append(scanned)
    steps = count(1)
    found = correct_together(prepared, tell=lambda _: progress("adjust", next(steps), None))
    if found is None:
        return NotAdjusted(_NOTHING)
    if not all(one.is_sound for one in found):
        return NotAdjusted(_WRONG)
    ways = tuple(map(_count_frames, passes, found))
    return LaidAlong(ways, found, _trace_errors(passes, laid, ways))


_RIGID = "the passes were moved as rigid bodies, not along their ways"
_NOTHING = f"{_RIGID}: nothing that they saw of the same places shows how they moved"
_WRONG = (
    f"{_RIGID}: adjusting them came to rest in a wrong place, where surface that was seen twice "
    "does not lie on its like. Are the logs those of these recordings, as good as [navigation] "
    "says, and are the lasers calibrated?"
)


def _prepare(one: NumberedPass, laid: Laid) -> LaidPass | NotAdjusted:
    """Gather what a pass knows of its way, or say why it cannot be adjusted."""
    path = one.source.path
    if not path.is_dir() or is_merged(project := Project(path)):
        return NotAdjusted(f"{_RIGID}: {path} is a cloud that does not know its profiles")
    try:
        moved, trajectory = project.finished(MOTION), project.load_trajectory()
        project.finished(TRIANGULATE)
    except MissingResult as missing:
        return NotAdjusted(f"{_RIGID}: {missing}")
    measured = project.load_measured()
    if measured is None:
        return NotAdjusted(
            f"{_RIGID}: nothing is stated of how good the log of {path} is, and such a log is "
            "never bent. Say in [navigation] of its rig file how good the instruments are, and run "
            "`murkscan scan` again"
        )
    if len(trajectory.times) < FEWEST:
        return NotAdjusted(f"{_RIGID}: {path} has poses for {len(trajectory.times)} frames only")
    profiles, axes = project.load_profile_parts(), load_scan_rig(project).axes
    return LaidPass(measured, profiles, axes, trajectory, laid.pose, moved.result.start)


def _count_frames(one: NumberedPass, found: Correction) -> Trajectory:
    way = one.source.count_frames(found.trajectory, one.low, one.frames)
    assert way is not None
    return way


def _trace_errors(
    passes: Sequence[NumberedPass], laid: Mapping[int, Laid], ways: Sequence[Trajectory]
) -> MergedErrors:
    """Trace how passes answer the errors of their rigs: as rigid bodies, laid by their overlap.

    What the errors of poses do stands in the ways, which were adjusted to one another.
    """
    seen = [one.see(way) for one, way in zip(passes, ways, strict=True)]
    errors = MergedErrors.of_passes(seen, is_joint=True)
    cloud, owner = PointCloud.empty(), np.zeros(0, np.int64)
    for number, one in laid.items():
        source = passes[number].sample(ways[number])
        mine = np.full(len(source), number)
        if one.alignment is not None:
            pairs = one.alignment.pairs.points
            ours, theirs = (nearest_in_cloud(part, pairs) for part in (source, cloud))
            apart = errors.shifts(mine[ours], source[ours])
            apart -= errors.shifts(owner[theirs], cloud[theirs])
            answer = one.alignment.answer(errors.answer_rigs(apart))
            errors = errors.lay(number, one.alignment.centre, np.zeros((6, 6)), answer)
        cloud = PointCloud.concatenate([cloud, source])
        owner = np.append(owner, mine)
    return errors
