"""Lay passes over one object on another, and merge them into one cloud."""

import platform
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from importlib.metadata import version
from itertools import chain
from pathlib import Path

import numpy as np

from ..cloud import thin_clouds
from ..errors import Degenerate, InputError, MissingResult, NotEnoughData
from ..geometry.alignment import Alignment, align_clouds
from ..io.cloud_files import check_cloud_suffix, iterate_cloud_file
from ..project import CLOUD, MOTION, CloudResult, MotionResult, PassResult, Project, ScanRecord
from ..types.cloud import PointCloud
from ..types.cloud_part import CloudPart
from ..types.pose import Pose
from ..types.trajectory import Trajectory
from .alignment_words import alignment_result, describe_alignment
from .matched import share_matches
from .merged import is_merged, load_moments, load_way
from .progress import Progress, silent

_SAMPLE = 2_000_000
"""Points of a pass, about, that alignment looks at."""
_GAP = 1000
"""Frame numbers between two passes, so that none of their profiles count as neighbours."""
_LAST_FRAME = 2**31 - 1
"""The highest number of a frame that a cloud holds."""

Laid = tuple[Alignment | None, Sequence[float]]
"""How a pass was aligned, and which share of its matches lies in each of the passes."""
_STAYS: Laid = (None, ())


@dataclass(frozen=True)
class Pass:
    """One scan, or a cloud of somebody else."""

    path: Path

    def __iter__(self) -> Iterator[PointCloud]:
        """Give its points in blocks; points that cannot be are left out."""
        for block in self._blocks():
            yield block[block.is_sound()]

    def way(self, low: int, high: int) -> Trajectory | None:
        """Give the poses at its frames, their numbers for times; None where it has no poses."""
        if not self.path.is_dir():
            return None
        project = Project(self.path)
        try:
            way, moments = load_way(project), load_moments(project)
        except MissingResult:
            return None
        if way is None or moments is None:
            return None
        inside = (moments.frame >= low) & (moments.frame <= high)
        poses = way.at(moments.time[inside])
        return replace(poses, times=moments.frame[inside].astype(float))

    def count(self) -> tuple[int, int]:
        """Count its points, and those that are left out.

        Raises:
            MissingResult: There is no such folder or file, or it has no finished cloud.
            InputError: It has no points.
        """
        if not self.path.exists():
            raise MissingResult(f"{self.path} does not exist; give a scan's folder or a cloud.")
        if not self.path.is_dir():
            check_cloud_suffix(self.path)
        count = total = 0
        for block in self._blocks():
            count += int(block.is_sound().sum())
            total += len(block)
        if count == 0:
            why = f": all {total:,} have no place, sigma or normal that can be" if total else ""
            raise InputError(f"{self.path} has no points{why}; leave it out.")
        return count, total - count

    def _blocks(self) -> Iterator[PointCloud]:
        if self.path.is_dir():
            return Project(self.path).iterate_cloud()
        return iterate_cloud_file(self.path)


def merge_passes(
    paths: Sequence[Path],
    out: Path,
    *,
    align: bool = True,
    reach: float | None = None,
    voxel: float | None = None,
    command: Sequence[str] = (),
    progress: Progress = silent,
) -> CloudResult:
    """Make one cloud of several, in the frame of the first.

    Args:
        paths: Folders of scans with finished clouds, or files of clouds; at least one.
        out: A new folder, which becomes a project with a finished cloud stage.
        align: Whether to correct where the passes lie; otherwise they stay as logged.
        reach: Distance up to which surfaces are looked for in each other's place [m].
        voxel: Edge of the voxels to thin the result to [m]; None keeps all points.
        command: The words that were typed after `murkscan`, for the record.
        progress: Told how many passes are aligned.

    Raises:
        InputError: out is no new folder, a pass is empty or numbers its frames too high, or the
            voxels are too small for where the points lie.
        MissingResult: A pass does not exist, or has no finished cloud.
        FormatError: A file is damaged.
        NotEnoughData: A pass is no surface, or far larger or smaller than the others.
        Degenerate: A pass overlaps none of the others.
        DeviceError: The disk is full.
    """
    passes = [Pass(path) for path in paths]
    project = Project(out, tuple(command))
    project.check_writable()
    if (out / "scan.json").exists() and not is_merged(project):
        raise InputError(f"{out} holds a scan; give a new folder for the merged cloud with --out.")
    if out.resolve() in [path.resolve() for path in paths]:
        raise InputError(f"{out} is one of the passes; give a new folder with --out.")
    counts, left_out = zip(*(one.count() for one in passes), strict=True)
    laid = _align_all(passes, counts, reach, progress) if align else [_STAYS] * len(passes)
    told, moved = _place(passes, laid, left_out)
    blocks = iter(moved if voxel is None else thin_clouds(moved, voxel))
    # What is refused is refused by now, before anything is written.
    blocks = chain([next(blocks)], blocks)
    settings = {"align": align, "reach": reach, "voxel": voxel}
    inputs = {"passes": [[str(one.path), count] for one, count in zip(passes, counts, strict=True)]}
    stage = project.stage(CLOUD, settings=settings, inputs=inputs)
    with project.hold():
        since = time.monotonic()
        project.save_scan(_record(paths, project.command))
        stage.begin()
        points = 0
        for number, block in enumerate(blocks):
            project.save_cloud_part(number, CloudPart.whole(block))
            points += len(block)
            progress("merge", points, None)
        project.export_cloud(frames=False)
        result = CloudResult(points, outliers=0, passes=tuple(told))
        stage.finish(result, since=since)
        _follow(project, moved, since)
    return result


def _follow(project: Project, moved: "_Moved", since: float) -> None:
    """Write where the camera was, pass after pass, if each pass knows it."""
    ways = list(moved.ways())
    known = [way for way in ways if way is not None]
    stage = project.stage(MOTION, settings={}, inputs={"cloud": project.finished(CLOUD).digest})
    stage.begin()
    if len(known) < len(ways):
        return
    columns = ("times", "positions", "quaternions")
    joined = (np.concatenate([getattr(way, name) for way in known]) for name in columns)
    project.save_trajectory(Trajectory(*joined))
    stage.finish(MotionResult(sum(len(way.times) for way in known)), since=since)


def _record(paths: Sequence[Path], command: Sequence[str]) -> ScanRecord:
    """Give what scan.json says of a merged cloud: it has no recording and no rig of its own."""
    versions = {name: version(name) for name in ("murkscan", "numpy", "scipy", "small-gicp")}
    return ScanRecord(
        versions=versions | {"python": platform.python_version()},
        recording=None,
        rig={},
        command=tuple(command),
        merged=tuple(str(path) for path in paths),
    )


@dataclass(frozen=True)
class _Moved:
    """All passes, in the frame of the first; they can be gone through again."""

    passes: Sequence[Pass]
    poses: Sequence[Pose]
    first_frames: Sequence[int]
    """What is added to each pass's frame numbers."""
    frames: Sequence[tuple[int, int]]
    """First and last frame of each pass that has points, by its own count."""

    def ways(self) -> Iterator[Trajectory | None]:
        """Give the poses of each pass, with the merged cloud's frame numbers for times."""
        rows = zip(self.passes, self.poses, self.first_frames, self.frames, strict=True)
        for one, pose, first, (low, high) in rows:
            way = one.way(low, high)
            yield None if way is None else replace(way.carry(pose), times=way.times + first)

    def __iter__(self) -> Iterator[PointCloud]:
        for one, pose, first in zip(self.passes, self.poses, self.first_frames, strict=True):
            for block in one:
                yield replace(
                    block,
                    points=pose @ block.points,
                    normals=(block.normals @ pose.rotation.T).astype(np.float32),
                    frame=(block.frame.astype(np.int64) + first).astype(np.int32),
                )


def _place(
    passes: Sequence[Pass], laid: Sequence[Laid], left_out: Sequence[int]
) -> tuple[list[PassResult], _Moved]:
    told, first_frames, ranges, following = [], [], [], 0
    for one, (alignment, shares), broken in zip(passes, laid, left_out, strict=True):
        frames = [(int(b.frame.min()), int(b.frame.max())) for b in one if len(b)]
        low, high = min(low for low, _ in frames), max(high for _, high in frames)
        if following + high - low > _LAST_FRAME:
            raise InputError(
                f"{one.path} numbers its frames from {low} to {high}, for which there is no room; "
                "remove its column frame."
            )
        first_frames.append(following - low)
        ranges.append((low, high))
        told.append(
            PassResult(
                path=str(one.path),
                frames=(following, following + high - low),
                left_out=broken,
                words=describe_alignment(alignment) + _say_left_out(broken),
                alignment=alignment_result(alignment),
                laid_on=tuple(shares),
            )
        )
        following += high - low + _GAP
    poses = [Pose.identity() if a is None else a.target_from_source for a, _ in laid]
    return told, _Moved(passes, poses, first_frames, ranges)


def _say_left_out(count: int) -> str:
    words = "points without a place, or with a sigma or a normal that cannot be, were left out"
    return f"; {count:,} {words}" if count else ""


def _align_all(
    passes: Sequence[Pass], counts: Sequence[int], reach: float | None, progress: Progress
) -> list[Laid]:
    """Lay each pass on what is in place; one that does not overlap yet waits for others."""
    found = {0: _STAYS}
    placed = _sample(passes[0], counts[0])
    owner = np.zeros(len(placed), np.int64)
    waiting = list(range(1, len(passes)))
    progress("align", 1, len(passes))
    while waiting:
        refusal: Degenerate | None = None
        for number in waiting:
            source = _sample(passes[number], counts[number])
            try:
                alignment = align_clouds(source, placed, reach=reach)
            except Degenerate as error:
                refusal = error
                continue
            except NotEnoughData as error:
                raise NotEnoughData(
                    f"{passes[number].path} cannot be laid on the passes before it: it measures "
                    f"{_size(source):.3g} m, and they {_size(placed):.3g} m. Give clouds of "
                    f"surfaces in metres. ({error})"
                ) from error
            pose = alignment.target_from_source
            source = replace(
                source,
                points=pose @ source.points,
                normals=(source.normals @ pose.rotation.T).astype(np.float32),
            )
            found[number] = (alignment, share_matches(source, placed, owner, alignment.overlap))
            placed = PointCloud.concatenate([placed, source])
            owner = np.append(owner, np.full(len(source), number))
            waiting.remove(number)
            progress("align", len(found), len(passes))
            break
        else:
            raise Degenerate(f"{passes[waiting[-1]].path}: {refusal}") from refusal
    return [found[number] for number in range(len(passes))]


def _size(cloud: PointCloud) -> float:
    return float(np.linalg.norm(np.ptp(cloud.points, axis=0)))


def _sample(one: Pass, count: int) -> PointCloud:
    step = max(count // _SAMPLE, 1)
    return PointCloud.concatenate([block[::step] for block in one])
