"""Merge a scan's profiles into one cloud, block by block."""

from collections import Counter
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import replace

import numpy as np

from ..cloud import OUTLIER_RULES, AbstractOutlierRule, SeenCloud, find_outliers, merge_profiles
from ..project import CLOUD, EXTRACT, MOTION, TRIANGULATE, CloudResult, Project, describe
from ..types.cloud import PointCloud
from ..types.laser import Axis
from ..types.rig import Rig
from ..types.trajectory import Trajectory
from .common_part import spread_common
from .profile_blocks import BLOCK, ProfileBlock, cut_blocks
from .progress import Progress, silent
from .scan_rig import moving_rig
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
    sources = project.finished(TRIANGULATE), project.finished(MOTION)
    rig, extracted = moving_rig(project, rig), project.finished(EXTRACT).result
    stage = project.stage(
        CLOUD,
        settings={"frames": frames, "rules": describe(tuple(rules))},
        inputs={"triangulate": sources[0].digest, "motion": sources[1].digest}
        | {"covariance": describe(rig.covariance)},
    )

    def make(trajectory: Trajectory) -> CloudResult:
        axis = rig.lasers[extracted.laser].axis
        blocks = cut_blocks(project.load_placed_parts(), block=block)
        found: Counter[str] = Counter({rule.cause: 0 for rule in rules})
        points = 0
        with ExitStack() as stack:
            write = [stack.enter_context(project.writing_cloud())]
            if frames or extracted.frames <= FRAME_FILES:
                write.append(stack.enter_context(project.writing_frames()))
            for done, one in enumerate(blocks):
                progress("cloud", done, None)
                cloud, causes = _merge(one, trajectory, rig, axis, rules)
                for save in write:
                    save(cloud)
                points += len(cloud)
                found.update(causes)
        return CloudResult(points, found.total(), dict(found))

    return run_stage(project, stage, make, prepare=project.load_trajectory, progress=progress)


def _merge(
    block: ProfileBlock,
    trajectory: Trajectory,
    rig: Rig,
    axis: Axis,
    rules: Sequence[AbstractOutlierRule],
) -> tuple[PointCloud, dict[str, int]]:
    """Give a block's points, and count what was taken out of it."""
    profile, is_body = block.profile, block.is_body
    cloud = merge_profiles(profile, trajectory, axis=axis)
    cameras = trajectory.transform(np.zeros_like(profile.points), profile.time)
    found = find_outliers(SeenCloud(cloud, cameras), rules)
    kept = is_body & ~np.any([*found.values(), np.zeros(len(cloud), bool)], axis=0)
    kept_cloud = replace(cloud[kept], sigma_common=spread_common(profile[kept], rig))
    return kept_cloud, {cause: int((which & is_body).sum()) for cause, which in found.items()}
