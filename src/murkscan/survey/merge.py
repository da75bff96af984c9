"""Lay passes over one object on another, and merge them into one cloud that knows them."""

import platform
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from importlib.metadata import version
from itertools import chain
from pathlib import Path

import numpy as np

from ..cloud import thin_clouds
from ..errors import Degenerate, InputError, NotEnoughData
from ..geometry.alignment import Alignment, align_clouds
from ..geometry.alignment_words import describe_alignment
from ..geometry.surface_points import nearest_in_cloud
from ..optics.merged_errors import MergedErrors, Moves
from ..project import (
    CLOUD,
    MOTION,
    AlignmentResult,
    CloudResult,
    MotionResult,
    PassRecord,
    PassResult,
    Project,
    ScanRecord,
    describe,
    is_merged,
)
from ..project.passes import NumberedPass, PassSource, expand_merged, look_at, number_passes
from ..types.arrays import Indices, Mask
from ..types.cloud import PointCloud
from ..types.cloud_part import CloudPart
from ..types.pose import Pose
from ..types.trajectory import Trajectory
from .progress import Progress, silent
from .stage_runner import run_stage


def merge_passes(
    paths: Sequence[Path],
    out: Path,
    *,
    align: bool = True,
    reach: float | None = None,
    voxel: float | None = None,
    unit: float = 1.0,
    starts: Sequence[Pose] = (),
    command: Sequence[str] = (),
    progress: Progress = silent,
) -> CloudResult:
    """Make one cloud of several, in the frame of the first; what is done already is skipped.

    Args:
        paths: Folders of scans with finished clouds, or files of clouds; at least one. A folder
            that was merged stands for its passes.
        out: A new folder, or one of an earlier merge, which becomes a project with finished motion
            and cloud stages.
        align: Whether to correct where the passes lie; otherwise they stay as logged.
        reach: Distance up to which surfaces are looked for in each other's place [m].
        voxel: Edge of the voxels to thin the result to [m]; None keeps all points.
        unit: Length of the unit of clouds of other programs [m]; scans are in metres.
        starts: Where each path after the first lies in the world of the first, about: aligning
            begins there. None: where it is.
        command: The words that were typed after `murkscan`, for the record.
        progress: Told how many passes are aligned.

    Raises:
        InputError: out is no new folder, there is not one start for each path after the first, a
            pass is empty or numbers its frames too high, or the
            voxels are too small for where the points lie.
        MissingResult: A pass does not exist, or has no finished cloud.
        FormatError: A file is damaged.
        NotEnoughData: A pass is no surface, or far larger or smaller than the others.
        Degenerate: A pass overlaps none of the others.
        DeviceError: The disk is full.
    """
    project = Project(out, tuple(command))
    sources, begin = _expand(paths, unit, starts)
    _check_out(project, sources)
    records = [source.as_record(out) for source in sources]
    stage = project.stage(
        CLOUD,
        settings={"align": align, "reach": reach, "voxel": voxel}
        | ({"starts": describe(tuple(starts))} if starts else {}),
        inputs={"passes": [one.identity for one in records]},
    )
    ready = None
    if stage.result() is None:  # what is refused is refused before anything is written
        passes = number_passes([*map(look_at, sources, records)])
        laid = _align_all(passes, begin, reach, progress) if align else [_STAYS] * len(passes)
        moved = _Moved(passes, [one.pose for one in laid])
        blocks = iter(moved if voxel is None else thin_clouds(moved, voxel))
        ready = chain([next(blocks)], blocks), tuple(map(_tell, passes, laid))

    def make(_: None) -> CloudResult:
        assert ready is not None
        points, there = 0, {*project.find_cloud_parts()}
        for number, block in enumerate(ready[0]):
            if number not in there:
                project.save_cloud_part(number, CloudPart.whole(block))
            points += len(block)
            progress("merge", points, None)
        project.export_cloud(frames=False)
        return CloudResult(points, outliers=0, passes=ready[1])

    with project.hold():
        project.save_scan(_as_scan(records, project.command))
        result = run_stage(project, stage, make, prepare=lambda: None, progress=progress)
        _follow(project, sources, result)
    return result


def _expand(
    paths: Sequence[Path], unit: float, starts: Sequence[Pose]
) -> tuple[list[PassSource], list[Pose]]:
    """Give all passes, and where each lies, about."""
    if starts and len(starts) != len(paths) - 1:
        raise InputError(
            f"There are {len(starts)} starts for {len(paths)} passes; give one for each but the "
            "first, 0,0,0 for one that lies where it should."
        )
    begin = [Pose.identity(), *(starts or [Pose.identity()] * (len(paths) - 1))]
    found = [
        (source, start)
        for path, start in zip(paths, begin, strict=True)
        for source in expand_merged([path], unit=unit)
    ]
    return [source for source, _ in found], [start for _, start in found]


def _follow(project: Project, sources: Sequence[PassSource], merged: CloudResult) -> None:
    """Write where the camera was, pass after pass, as far as the passes know it."""
    stage = project.stage(MOTION, settings={}, inputs={"cloud": project.finished(CLOUD).digest})

    def prepare() -> list[Trajectory | None]:
        return [
            source.trajectory(one.first_frame, one.frames, _pose_of(one))
            for source, one in zip(sources, merged.passes, strict=True)
        ]

    def make(trajectories: list[Trajectory | None]) -> MotionResult:
        known = [one for one in trajectories if one is not None]
        if known:
            project.save_trajectory(Trajectory.concatenate(known))
        lengths = [one.frames[1] - one.frames[0] + 1 for one in merged.passes]
        missing = [n for n, one in zip(lengths, trajectories, strict=True) if one is None]
        return MotionResult(sum(len(one.times) for one in known), sum(missing))

    run_stage(project, stage, make, prepare=prepare, progress=silent)


def _check_out(project: Project, sources: Sequence[PassSource]) -> None:
    project.check_writable()
    out = project.root
    if (out / "scan.json").exists() and not is_merged(project):
        raise InputError(f"{out} holds a scan; give a new folder for the merged cloud with --out.")
    if out.resolve() in [source.path.resolve() for source in sources]:
        raise InputError(f"{out} is one of the passes; give a new folder with --out.")


def _as_scan(passes: Sequence[PassRecord], command: Sequence[str]) -> ScanRecord:
    """Make scan.json of a merged cloud: its recordings and rigs are those of its passes."""
    versions = {name: version(name) for name in ("murkscan", "numpy", "scipy", "small-gicp")}
    return ScanRecord(
        versions=versions | {"python": platform.python_version()},
        recording=None,
        rig={},
        command=tuple(command),
        passes=tuple(passes),
    )


@dataclass(frozen=True, eq=False)
class _Laid:
    """How a pass was laid on others; the first one stays."""

    alignment: Alignment | None = None
    shares: Sequence[float] = ()
    """Which share of its matches lies in each of the passes."""
    answers: Moves | None = None

    @property
    def pose(self) -> Pose:
        """Where it is laid."""
        return Pose.identity() if self.alignment is None else self.alignment.target_from_source


_STAYS = _Laid()


@dataclass(frozen=True, eq=False)
class _Placed:
    """What is in place, and what is known of its errors."""

    cloud: PointCloud
    """A sample of its points, by the merged cloud's count."""
    owner: Indices
    """Number of the pass of each."""
    errors: MergedErrors
    laid: Mapping[int, _Laid]
    """How each of the passes was laid."""

    @cached_property
    def facing(self) -> Mask:
        """Which of its points turn neither from their camera nor from their light."""
        return self.errors.is_facing(self.owner, self.cloud)

    @classmethod
    def begin(cls, passes: Sequence[NumberedPass]) -> "_Placed":
        """Leave the first pass where it is."""
        cloud = passes[0].sample()
        errors = MergedErrors.of_passes([one.see(Pose.identity()) for one in passes])
        return cls(cloud, np.zeros(len(cloud), np.int64), errors, {0: _STAYS})

    def add(self, number: int, one: NumberedPass, alignment: Alignment) -> "_Placed":
        """Lay a pass, and trace how its place follows the errors of both sides."""
        pose = alignment.target_from_source
        source, errors = one.sample().carry(pose), self.errors.place(number, one.see(pose))
        ours, theirs = (
            nearest_in_cloud(cloud, alignment.pairs.points) for cloud in (source, self.cloud)
        )
        owner, mine = self.owner[theirs], np.full(len(ours), number)
        apart = errors.shifts(mine, source[ours]) - errors.shifts(owner, self.cloud[theirs])
        errors = errors.lay(number, alignment.centre, alignment.covariance, alignment.answer(apart))
        answer = errors.answers[number]
        assert answer is not None
        shares = np.bincount(owner) / len(owner)
        return _Placed(
            PointCloud.concatenate([self.cloud, source]),
            np.append(self.owner, np.full(len(source), number)),
            errors,
            {**self.laid, number: _Laid(alignment, shares.tolist(), answer.moves)},
        )


@dataclass(frozen=True)
class _Moved:
    """All passes, in the frame of the first; they can be gone through again."""

    passes: Sequence[NumberedPass]
    poses: Sequence[Pose]

    def __iter__(self) -> Iterator[PointCloud]:
        for one, pose in zip(self.passes, self.poses, strict=True):
            yield from one.blocks(pose)


def _tell(one: NumberedPass, laid: _Laid) -> PassResult:
    words = describe_alignment(laid.alignment)
    if one.left_out:
        words += (
            f"; {one.left_out:,} points without a place, or with a sigma or a normal that cannot "
            "be, were left out"
        )
    alignment = laid.alignment
    poses = one.source.trajectory(one.low, one.frames, laid.pose)
    return PassResult(
        path=str(one.source.path),
        frames=one.frames,
        left_out=one.left_out,
        words=words,
        alignment=None if alignment is None else AlignmentResult.from_alignment(alignment),
        laid_on=tuple(laid.shares),
        first_frame=one.low,
        points=one.count,
        pose_errors=0 if poses is None else poses.num_errors,
        answers=() if laid.answers is None else tuple(map(tuple, laid.answers.tolist())),
    )


def _pose_of(one: PassResult) -> Pose:
    if one.alignment is None:
        return Pose.identity()
    return Pose(np.array(one.alignment.rotation), np.array(one.alignment.translation))


def _align_all(
    passes: Sequence[NumberedPass],
    begin: Sequence[Pose],
    reach: float | None,
    progress: Progress,
) -> list[_Laid]:
    """Lay each pass on what is in place; one that does not overlap yet waits for others."""
    placed, waiting = _Placed.begin(passes), list(range(1, len(passes)))
    progress("align", 1, len(passes))
    while waiting:
        refusal: Degenerate | None = None
        for number in waiting:
            try:
                alignment = _align(passes[number], number, placed, begin[number], reach)
            except Degenerate as error:
                refusal = error
                continue
            placed = placed.add(number, passes[number], alignment)
            waiting.remove(number)
            progress("align", len(placed.laid), len(passes))
            break
        else:
            raise Degenerate(f"{passes[waiting[-1]].source.path}: {refusal}") from refusal
    return [placed.laid[number] for number in range(len(passes))]


def _align(
    one: NumberedPass, number: int, placed: _Placed, start: Pose, reach: float | None
) -> Alignment:
    """Lay a pass on others by what faced the cameras, if that tells all: flanks are seen wrong."""
    source = one.sample()
    facing = placed.errors.is_facing(np.full(len(source), number), source)
    try:
        with suppress(Degenerate, NotEnoughData):
            target = placed.cloud[placed.facing]
            found = align_clouds(source[facing], target, reach=reach, start=start)
            if not found.open_directions:
                return found
        return align_clouds(source, placed.cloud, reach=reach, start=start)
    except NotEnoughData as error:
        raise NotEnoughData(
            f"{one.source.path} cannot be laid on the passes before it: it measures "
            f"{_size(source):.3g} m, and they {_size(placed.cloud):.3g} m. Give clouds of surfaces "
            f"in metres, or their unit with --unit. ({error})"
        ) from error


def _size(cloud: PointCloud) -> float:
    return float(np.linalg.norm(np.ptp(cloud.points, axis=0)))
