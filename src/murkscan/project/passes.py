"""The passes of a merged cloud where they lie: their points, their poses, and what each is."""

import os
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ..errors import InputError, MissingResult
from ..io.checksum import mark_file
from ..io.cloud_files import check_cloud_to_read, iterate_cloud_file
from ..io.values import as_plain
from ..optics.merged_errors import SeenPass
from ..types.cloud import PointCloud
from ..types.pose import Pose
from ..types.trajectory import Trajectory
from .describe import digest
from .folder import Project
from .kinds import CLOUD, MOTION
from .merged import load_pass_rig, rig_key
from .scan_record import PassRecord
from .scanned import find_frame_times, find_trajectory, is_merged

Placement = Pose | Trajectory
"""Where a pass lies in the merged world: as a rigid body, or along its whole way, as
world_from_camera with the merged cloud's frame numbers for times."""

_SAMPLE = 2_000_000
"""Points of a pass, about, that are looked at to align it."""
_GAP = 1000
"""Frame numbers between two passes, so that none of their profiles count as neighbours."""
_LAST_FRAME = 2**31 - 1
"""The highest number of a frame that a cloud holds."""


def expand_merged(paths: Sequence[Path], *, unit: float = 1.0) -> Iterator["PassSource"]:
    """Put the passes of a merged folder in its place, so that all errors are traced anew.

    One that was imported from a single cloud of another program stays as it is.

    Args:
        paths: Folders of scans and of merged clouds, and files of clouds.
        unit: Length of the files' unit [m]; a folder is in metres.
    """
    for path in paths:
        passes: Sequence[PassRecord] = ()
        if path.is_dir() and is_merged(project := Project(path)):
            passes = project.load_scan().passes
        if len(passes) > 1 or any(one.scan is not None for one in passes):
            yield from (
                PassSource(Path(os.path.normpath(path / one.path)), one.scale) for one in passes
            )
        else:
            yield PassSource(path, 1.0 if path.is_dir() else unit)


@dataclass(frozen=True)
class PassSource:
    """The folder of a scan, or a cloud of another program."""

    path: Path
    unit: float = 1.0
    """Length of the unit of a cloud of another program [m]."""

    def blocks(self) -> Iterator[PointCloud]:
        """Read its points."""
        if self.path.is_dir():
            return Project(self.path).iterate_cloud()
        return (block.scaled(self.unit) for block in iterate_cloud_file(self.path))

    def as_record(self, out: Path) -> PassRecord:
        """Say what it is, for the merged folder.

        Raises:
            MissingResult: There is no such folder or file, or it has no finished cloud.
            InputError: It is no cloud's file.
        """
        if not self.path.exists():
            raise MissingResult(f"{self.path} does not exist; give a scan's folder or a cloud.")
        path = _relative(self.path, out)
        if not self.path.is_dir():
            check_cloud_to_read(self.path)
            identity = mark_file(self.path).blake2b
            if self.unit != 1.0:
                identity += f" in {self.unit:g} m"
            return PassRecord(path, identity, scale=self.unit)
        project = Project(self.path)
        stages, carries_mount = [project.finished(CLOUD).record], False
        with suppress(MissingResult):
            moved = project.finished(MOTION)
            stages.append(moved.record)
            carries_mount = moved.result.carries_mount
        identity = digest([[one.key.digest, as_plain(one.files)] for one in stages])
        return PassRecord(path, identity, project.load_scan(), carries_mount)

    def trajectory(
        self, first_frame: int, frames: tuple[int, int], world_from_pass: Pose
    ) -> Trajectory | None:
        """Read the poses at its frames, their merged numbers for times; None where it has none.

        Args:
            first_frame: Its own number of the first of the frames.
            frames: The first and the last by the merged cloud's count.
            world_from_pass: Where it is laid.
        """
        if not self.path.is_dir():
            return None
        try:
            known = find_trajectory(Project(self.path))
        except MissingResult:
            return None
        way = None if known is None else self.count_frames(known, first_frame, frames)
        return None if way is None else way.carry(world_from_pass)

    def count_frames(
        self, way: Trajectory, first_frame: int, frames: tuple[int, int]
    ) -> Trajectory | None:
        """Give a way at its frames, their merged numbers for times; None where it has no times.

        Args:
            way: By the times of its recording.
            first_frame: As for `trajectory`.
            frames: As for `trajectory`.
        """
        try:
            all_frames = find_frame_times(Project(self.path))
        except MissingResult:
            return None
        if all_frames is None:
            return None
        numbers = all_frames.frame.astype(np.int64) + (frames[0] - first_frame)
        inside = (numbers >= frames[0]) & (numbers <= frames[1])
        return replace(way.at(all_frames.time[inside]), times=numbers[inside].astype(float))


def _relative(path: Path, out: Path) -> str:
    try:
        return Path(os.path.relpath(path.resolve(), out.resolve())).as_posix()
    except ValueError:  # another drive
        return path.resolve().as_posix()


@dataclass(frozen=True)
class NumberedPass:
    """A pass and how its points are numbered."""

    source: PassSource
    record: PassRecord
    count: int
    """Points that can be."""
    left_out: int
    """Those that cannot."""
    low: int
    """First of its frames that has points, by its own count."""
    high: int
    """The last one."""
    first: int = 0
    """The first one by the merged cloud's count."""

    @property
    def frames(self) -> tuple[int, int]:
        """First and last frame by the merged cloud's count."""
        return self.first, self.first + self.high - self.low

    def blocks(self, place: Placement) -> Iterator[PointCloud]:
        """Read its points where they are laid; points that cannot be are left out."""
        own = self.trajectory(Pose.identity()) if isinstance(place, Trajectory) else None
        for block in self.source.blocks():
            sound = block[block.is_sound()]
            frame = sound.frame.astype(np.int64) + (self.first - self.low)
            numbered = replace(sound, frame=frame.astype(np.int32))
            if isinstance(place, Pose):
                yield numbered.carry(place)
            else:
                assert own is not None
                yield _lay_along(numbered, own, place)

    def sample(self, place: Placement | None = None) -> PointCloud:
        """Read about two million of its points, as they lie unless they are laid elsewhere."""
        step = max(self.count // _SAMPLE, 1)
        blocks = self.blocks(place or Pose.identity())
        return PointCloud.concatenate([block[::step] for block in blocks])

    def trajectory(self, place: Placement) -> Trajectory | None:
        """Give the poses at its frames where it is laid; None where it has none."""
        if isinstance(place, Trajectory):
            return place
        return self.source.trajectory(self.low, self.frames, place)

    def see(self, place: Placement) -> SeenPass | None:
        """Tell how it was seen; None where its rig or its poses are not known."""
        rig = load_pass_rig(Project(self.source.path), self.record)
        trajectory = self.trajectory(place)
        if rig is None or trajectory is None:
            return None
        return SeenPass(rig, trajectory, rig_key(self.record))


def _lay_along(cloud: PointCloud, own: Trajectory, way: Trajectory) -> PointCloud:
    """Carry points from where their own poses have them to another way of the same camera."""
    times = cloud.frame.astype(float)
    ends = own.to_camera(cloud.points + cloud.normals, times)
    seen = own.to_camera(cloud.points, times)
    points = way.transform(seen, times)
    normals = (way.transform(ends, times) - points).astype(np.float32)
    return replace(cloud, points=points, normals=normals)


def look_at(source: PassSource, record: PassRecord) -> NumberedPass:
    """Count the points of a pass, and find its first and last frame.

    Raises:
        InputError: It has no points.
        FormatError: It is damaged.
    """
    count = total = 0
    low, high = _LAST_FRAME, -_LAST_FRAME
    for block in source.blocks():
        sound = block[block.is_sound()]
        count, total = count + len(sound), total + len(block)
        if len(sound):
            low, high = min(low, int(sound.frame.min())), max(high, int(sound.frame.max()))
    if count == 0:
        why = f": all {total:,} have no place, sigma or normal that can be" if total else ""
        raise InputError(f"{source.path} has no points{why}; leave it out.")
    return NumberedPass(source, record, count, total - count, low, high)


def number_passes(passes: Sequence[NumberedPass]) -> list[NumberedPass]:
    """Set the frames of the passes apart.

    Raises:
        InputError: There are not enough numbers for the frames of all.
    """
    numbered, following = list[NumberedPass](), 0
    for one in passes:
        if following + one.high - one.low > _LAST_FRAME:
            raise InputError(
                f"{one.source.path} numbers its frames from {one.low} to {one.high}, for which "
                "there is no room; remove its column frame."
            )
        numbered.append(replace(one, first=following))
        following += one.high - one.low + _GAP
    return numbered
