"""Merge a scan's profiles into one cloud, block by block."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..cloud import OUTLIER_RULES, AbstractOutlierRule, SeenCloud, find_outliers, merge_profiles
from ..cloud.blocks import BLOCK, ProfileBlock, cut_blocks
from ..project import (
    CLOUD,
    EXTRACT,
    MOTION,
    TRIANGULATE,
    CloudResult,
    Project,
    as_it_moves,
    describe,
)
from ..types.cloud import empty_cloud
from ..types.cloud_part import CloudPart
from ..types.laser import Axis
from ..types.rig import Rig
from ..types.trajectory import Trajectory
from .common_part import spread_common
from .progress import Progress, silent
from .stage_runner import run_stage

FRAME_FILES = 500
"""Frames up to which the paper's one cloud a frame is written without being asked for."""


def build_cloud(
    project: Project,
    rig: Rig,
    *,
    rules: Sequence[AbstractOutlierRule] = OUTLIER_RULES,
    frames: bool = False,
    block: int = BLOCK,
    progress: Progress = silent,
) -> CloudResult:
    """Run the cloud stage; a scan that does not fit into memory is worked on in blocks.

    Args:
        project: A scan with finished triangulate and motion stages.
        rig: Its rig.
        rules: The reasons not to believe a point.
        frames: Whether to write one cloud a frame for more than 500 frames, too.
        block: Points that are worked on at once, about.
        progress: Told how many blocks are done.

    Raises:
        MissingResult: An earlier stage has not been finished.
        DeviceError: The disk is full.
    """
    triangulated, moved = project.finished(TRIANGULATE), project.finished(MOTION)
    rig = as_it_moves(rig, carries_mount=moved.result.carries_mount)
    extracted = project.finished(EXTRACT).result
    stage = project.stage(
        CLOUD,
        settings={"frames": frames, "rules": describe(tuple(rules))},
        inputs={"triangulate": triangulated.digest, "motion": moved.digest}
        | {"covariance": describe(rig.covariance)},
    )

    def make(trajectory: Trajectory) -> CloudResult:
        judge = _Judge(trajectory, rig, rig.lasers[extracted.laser].axis, rules)
        _make_parts(project, judge, block, progress)
        project.export_cloud(frames=frames or extracted.frames <= FRAME_FILES)
        return _count(project, rules)

    return run_stage(project, stage, make, prepare=project.load_trajectory, progress=progress)


@dataclass(frozen=True)
class _Judge:
    """What every block needs."""

    trajectory: Trajectory
    rig: Rig
    axis: Axis
    rules: Sequence[AbstractOutlierRule]

    def place(self, block: ProfileBlock) -> CloudPart:
        """Carry a block's points to the world, and tell which of them are no surface."""
        profile, is_body = block.profile, block.is_body
        if not len(profile):
            return CloudPart.whole(empty_cloud())
        cloud = merge_profiles(profile, self.trajectory, axis=self.axis)
        cameras = self.trajectory.transform(np.zeros_like(profile.points), profile.time)
        found = find_outliers(SeenCloud(cloud, cameras), self.rules)
        taken_out = np.zeros(len(cloud), np.uint8)
        for number, which in enumerate(found.values(), 1):
            taken_out[which] = number
        common = spread_common(profile[is_body], self.rig)
        body = replace(cloud[is_body], sigma_common=common)
        return CloudPart(body, taken_out[is_body], tuple(found))


def _make_parts(project: Project, judge: _Judge, block: int, progress: Progress) -> None:
    """Make the parts that are missing, a block at a time."""
    there, waiting = {*project.find_cloud_parts()}, sorted(project.find_profile_parts())
    for done, one in enumerate(cut_blocks(project.load_placed_parts(), block=block)):
        progress("cloud", done, None)
        numbers, waiting = waiting[: len(one.sizes)], waiting[len(one.sizes) :]
        if there.issuperset(numbers):
            continue
        placed, ends = judge.place(one), np.cumsum(one.sizes)
        for number, size, end in zip(numbers, one.sizes, ends.tolist(), strict=True):
            project.save_cloud_part(number, placed[end - size : end])


def _count(project: Project, rules: Sequence[AbstractOutlierRule]) -> CloudResult:
    points, found = 0, Counter({rule.cause: 0 for rule in rules})
    for number in project.find_cloud_parts():
        part = project.load_cloud_part(number)
        points += int(part.stays.sum())
        found.update({rule.cause: part.count(rule.cause) for rule in rules})
    return CloudResult(points, found.total(), dict(found))
