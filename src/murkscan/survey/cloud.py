"""Merge a scan's profiles into one cloud, block by block."""

from collections import Counter
from collections.abc import Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np

from ..cloud import OUTLIER_RULES, AbstractOutlierRule, SeenCloud, find_outliers, merge_profiles
from ..distribute import AbstractExecutor, Threads
from ..optics.reflectance import StripeBrightness
from ..optics.seen_points import spread_common
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
from ..project.blocks import BLOCK, Block, cut_blocks, trim_beside
from ..types.cloud import PointCloud
from ..types.cloud_part import CloudPart
from ..types.profile import Profile
from ..types.rig import Rig
from ..types.trajectory import Trajectory
from .progress import Progress, silent
from .reflectance import find_brightness, tell_reflectance
from .stage_runner import run_stage

FRAME_FILES = 500
"""Frames up to which the paper's one cloud a frame is written without being asked for."""


def build_cloud(
    project: Project,
    rig: Rig,
    *,
    rules: Sequence[AbstractOutlierRule] = OUTLIER_RULES,
    attenuation: float | None = None,
    frames: bool = False,
    block: int = BLOCK,
    executor: AbstractExecutor | None = None,
    progress: Progress = silent,
) -> CloudResult:
    """Run the cloud stage; a scan that does not fit into memory is worked on in blocks.

    Args:
        project: A scan with finished triangulate and motion stages.
        rig: Its rig.
        rules: The reasons not to believe a point.
        attenuation: Beam attenuation of the water [1/m], for the points' reflectance; what the glow
            told unless given.
        frames: Whether to write one cloud a frame for more than 500 frames, too.
        block: Points that are worked on at once, about; the result depends on it.
        executor: Who does it; threads unless given. The result is the same.
        progress: Told how many blocks are done.

    Raises:
        MissingResult: An earlier stage has not been finished.
        DeviceError: The disk is full.
    """
    triangulated, moved = project.finished(TRIANGULATE), project.finished(MOTION)
    rig = as_it_moves(rig, carries_mount=moved.result.carries_mount)
    extracted = project.finished(EXTRACT).result
    water = extracted.attenuation
    if attenuation is None and water is not None and water.is_telling:
        attenuation = water.effective
    stage = project.stage(
        CLOUD,
        settings={"frames": frames, "rules": describe(tuple(rules)), "attenuation": attenuation},
        inputs={"triangulate": triangulated.digest, "motion": moved.digest}
        | {"covariance": describe(rig.covariance)},
    )

    def make(sizes: Mapping[int, int]) -> CloudResult:
        bright = find_brightness(project, rig, extracted.lasers, attenuation)
        job = _Job(project, moved.digest, rig, tuple(rules), bright)
        blocks = cut_blocks(sizes, block=block)
        result = _make_parts(job, blocks, executor or Threads(), progress)
        project.export_cloud(frames=frames or extracted.frames <= FRAME_FILES)
        return replace(result, attenuation=attenuation)

    return run_stage(project, stage, make, prepare=project.count_profile_points, progress=progress)


@dataclass(frozen=True, eq=False)
class _Job:
    """What every block needs, wherever it is worked on."""

    project: Project
    motion: str
    """Digest of the motion stage."""
    rig: Rig
    rules: Sequence[AbstractOutlierRule]
    brightness: Mapping[int, StripeBrightness]
    """By the number of the laser."""

    def place(self, block: Block) -> list[CloudPart]:
        """Carry a block's points to the world, and tell which of them are no surface."""
        trajectory = _load_trajectory(self.project.root, self.motion)
        profile, sizes = self._load(block, trajectory)
        own = slice(sizes[0], len(profile) - sizes[-1])
        if not len(profile):
            return [CloudPart.whole(PointCloud.empty()) for _ in block.parts]
        cloud = merge_profiles(profile, trajectory, axes=self.rig.axes)
        cameras = trajectory.transform(np.zeros_like(profile.points), profile.time)
        found = find_outliers(SeenCloud(cloud, cameras), self.rules)
        taken_out = np.zeros(len(cloud), np.uint8)
        for number, which in enumerate(found.values(), 1):
            taken_out[which] = number
        common = spread_common(profile[own], trajectory, self.rig)
        paint = tell_reflectance(profile[own], cloud[own].normals, trajectory, self.brightness)
        told = replace(cloud[own], sigma_common=common, reflectance=paint)
        placed = CloudPart(told, taken_out[own], tuple(found))
        ends = np.cumsum(sizes[1:-1]).tolist()
        return [placed[end - size : end] for size, end in zip(sizes[1:-1], ends, strict=True)]

    def _load(self, block: Block, trajectory: Trajectory) -> tuple[Profile, list[int]]:
        """Load a block; gives the sizes of what lies before it, of its parts, of what follows."""
        before, after = (self._join(numbers, trajectory) for numbers in (block.before, block.after))
        before, after = trim_beside(before, after)
        parts = [before, *(self._join([one], trajectory) for one in block.parts), after]
        return Profile.concatenate(parts), list(map(len, parts))

    def _join(self, numbers: Sequence[int], trajectory: Trajectory) -> Profile:
        parts = (self.project.load_profile_part(number) for number in numbers)
        return Profile.concatenate([part[trajectory.has(part.time)] for part in parts])


@lru_cache(maxsize=1)
def _load_trajectory(root: Path, digest: str) -> Trajectory:
    """Read the poses once a worker; the digest tells whether they are still the same."""
    del digest
    return Project(root).load_trajectory()


def _make_parts(
    job: _Job, blocks: Sequence[Block], executor: AbstractExecutor, progress: Progress
) -> CloudResult:
    """Make the parts that are missing, a block at a time; this process alone writes."""
    project, counts = job.project, Counter({rule.cause: 0 for rule in job.rules})
    there, points = {*project.find_cloud_parts()}, 0
    missing = [one for one in blocks if not there.issuperset(one.parts)]
    whole = [number for one in blocks if one not in missing for number in one.parts]

    def count(part: CloudPart) -> None:
        nonlocal points
        points += int(part.stays.sum())
        counts.update({rule.cause: part.count(rule.cause) for rule in job.rules})

    with closing(executor.map(job.place, missing)) as made:
        for done, (one, parts) in enumerate(zip(missing, made, strict=True), 1):
            for number, part in zip(one.parts, parts, strict=True):
                project.save_cloud_part(number, part)
                count(part)
            progress("cloud", done, len(missing))
    for number in whole:
        count(project.load_cloud_part(number))
    return CloudResult(points, counts.total(), dict(counts))
