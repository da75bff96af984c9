"""Lay passes over one object on another, and merge them into one cloud that knows them."""

import math
import platform
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from importlib.metadata import version
from itertools import chain
from pathlib import Path

import numpy as np

from ..cloud import thin_clouds
from ..errors import InputError
from ..geometry.alignment_words import describe_alignment
from ..motion.correction_words import tell_correction_of_pass
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
from ..project.passes import (
    NumberedPass,
    PassSource,
    Placement,
    expand_merged,
    look_at,
    number_passes,
)
from ..types.cloud import PointCloud
from ..types.cloud_part import CloudPart
from ..types.pose import Pose
from ..types.trajectory import Trajectory
from .lay_along import LaidAlong, NotAdjusted, lay_along
from .lay_rigidly import STAYS, Laid, lay_rigidly
from .progress import Progress, silent
from .stage_runner import run_stage


def merge_passes(
    paths: Sequence[Path],
    out: Path,
    *,
    align: bool = True,
    adjust: bool = True,
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
        adjust: Whether to correct each pass along its whole way, where the accuracy of all logs is
            stated; otherwise passes are moved as rigid bodies.
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
        settings={"align": align, "adjust": adjust and align, "reach": reach, "voxel": voxel}
        | ({"starts": describe(tuple(starts))} if starts else {}),
        inputs={"passes": [one.identity for one in records]},
    )
    laying = _Laying(sources, records, begin, align, adjust and align, reach, progress)
    ready = None
    if stage.result() is None:  # what is refused is refused before anything is written
        moved = _Moved(laying)
        blocks = iter(moved if voxel is None else thin_clouds(moved, voxel))
        ready = chain([next(blocks)], blocks), laying.tell()

    def make(_: None) -> CloudResult:
        assert ready is not None
        points, there = 0, {*project.find_cloud_parts()}
        for number, block in enumerate(ready[0]):
            if number not in there:
                project.save_cloud_part(number, CloudPart.whole(block))
            points += len(block)
            progress("merge", points, None)
        project.export_cloud(frames=False)
        return CloudResult(points, outliers=0, passes=ready[1], remarks=laying.remarks)

    with project.hold():
        project.save_scan(_as_scan(records, project.command))
        result = run_stage(project, stage, make, prepare=lambda: None, progress=progress)
        _follow(project, laying, result)
    return result


@dataclass(frozen=True, eq=False)
class _Laying:
    """Where the passes are laid: found when it is asked for, the same each time."""

    sources: Sequence[PassSource]
    records: Sequence[PassRecord]
    begin: Sequence[Pose]
    align: bool
    adjust: bool
    reach: float | None
    progress: Progress

    @cached_property
    def passes(self) -> list[NumberedPass]:
        """The passes, with their frames counted."""
        return number_passes([*map(look_at, self.sources, self.records)])

    @cached_property
    def laid(self) -> Mapping[int, Laid]:
        """How each was laid as a rigid body."""
        if not self.align:
            return dict.fromkeys(range(len(self.passes)), STAYS)
        return lay_rigidly(self.passes, self.begin, self.reach, self.progress)

    @cached_property
    def along(self) -> LaidAlong | NotAdjusted:
        """How they were adjusted along their ways, or why not."""
        is_scanned = any(one.scan is not None for one in self.records)
        if not self.adjust or len(self.sources) == 1 or not is_scanned:
            return NotAdjusted("")
        return lay_along(self.passes, self.laid, self.progress)

    @property
    def places(self) -> list[Placement]:
        """Where each pass lies."""
        if isinstance(self.along, LaidAlong):
            return [*self.along.ways]
        return [self.laid[number].pose for number in range(len(self.passes))]

    @property
    def remarks(self) -> tuple[str, ...]:
        """Why they were not adjusted along their ways."""
        words = "" if isinstance(self.along, LaidAlong) else self.along.words
        return (words,) if words else ()

    def tell(self) -> tuple[PassResult, ...]:
        """Say what became of each pass."""
        return tuple(map(self._tell, range(len(self.passes))))

    def _tell(self, number: int) -> PassResult:
        one, laid, along = self.passes[number], self.laid[number], self.along
        words = describe_alignment(laid.alignment)
        if one.left_out:
            words += (
                f"; {one.left_out:,} points without a place, or with a sigma or a normal that "
                "cannot be, were left out"
            )
        poses, moves = one.trajectory(self.places[number]), laid.answers
        correction: tuple[str, ...] = ()
        corrected = None
        if isinstance(along, LaidAlong):
            answer, found = along.errors.answers[number], along.corrections[number]
            moves = None if answer is None else answer.moves
            correction = tell_correction_of_pass(found)
            corrected = math.sqrt(float((found.moved**2).mean()))
        return PassResult(
            path=str(one.source.path),
            frames=one.frames,
            left_out=one.left_out,
            words=words,
            alignment=(
                None if laid.alignment is None else AlignmentResult.from_alignment(laid.alignment)
            ),
            laid_on=tuple(laid.shares),
            first_frame=one.low,
            points=one.count,
            pose_errors=0 if poses is None else poses.num_errors,
            answers=() if moves is None else tuple(map(tuple, moves.tolist())),
            correction=correction,
            corrected=corrected,
        )


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


def _follow(project: Project, laying: _Laying, merged: CloudResult) -> None:
    """Write where the camera was, pass after pass, as far as the passes know it."""
    stage = project.stage(MOTION, settings={}, inputs={"cloud": project.finished(CLOUD).digest})

    def prepare() -> list[Trajectory | None]:
        if merged.is_joint:
            assert isinstance(laying.along, LaidAlong)
            return [*laying.along.ways]
        return [
            source.trajectory(one.first_frame, one.frames, _pose_of(one))
            for source, one in zip(laying.sources, merged.passes, strict=True)
        ]

    def make(trajectories: list[Trajectory | None]) -> MotionResult:
        known = [one for one in trajectories if one is not None]
        join = Trajectory.concatenate_joint if merged.is_joint else Trajectory.concatenate
        if known:
            project.save_trajectory(join(known))
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


@dataclass(frozen=True)
class _Moved:
    """All passes, in the frame of the first; they can be gone through again."""

    laying: _Laying

    def __iter__(self) -> Iterator[PointCloud]:
        along = self.laying.along
        for number, (one, place) in enumerate(
            zip(self.laying.passes, self.laying.places, strict=True)
        ):
            for block in one.blocks(place):
                if isinstance(along, LaidAlong):
                    common = along.errors.spread(np.full(len(block), number), block)
                    yield replace(block, sigma_common=common)
                else:
                    yield block


def _pose_of(one: PassResult) -> Pose:
    if one.alignment is None:
        return Pose.identity()
    return Pose(np.array(one.alignment.rotation), np.array(one.alignment.translation))
