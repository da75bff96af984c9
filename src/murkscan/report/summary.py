"""All numbers of a report, in metres and seconds."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..types.background import Attenuation
from ..types.cloud import PointCloud
from ..types.frame_times import FrameTimes
from ..types.laser import Axis
from ..types.mesh import Mesh
from ..types.profile import Profile
from ..types.rig import Rig
from ..types.trajectory import Trajectory
from .spacing import spacing_across, spacing_along
from .spread import Spread
from .timeline import FrameStatistics, Timeline, frame_statistics, make_timeline
from .trust import Trust, judge_trust

_KEPT = 50_000
"""Numbers of each part of a scan that a spread is taken over, evenly picked."""


@dataclass(frozen=True)
class Recorded:
    """What was scanned."""

    name: str
    """The recording's file or folder."""
    size: tuple[int, int]
    """Width and height of the full frame [px]."""
    fields_per_picture: int = 1
    """2 where the recording is interlaced."""
    is_timed: bool = True
    """Whether times are real; otherwise they count pictures."""
    skips: Sequence[tuple[int, int, str]] = ()
    """What could not be read: index of the first frame, how many frames, and why."""
    remarks: Sequence[str] = ()
    """What is odd about the recording, with its cure."""
    attenuation: Attenuation | None = None
    """How murky the water was, where the glow told."""

    @property
    def num_skipped(self) -> int:
        """Frames that could not be read."""
        return sum(count for _, count, _ in self.skips)


@dataclass(frozen=True)
class Shown:
    """A picture that the report shows."""

    path: str
    """Relative to the report's page, with forward slashes."""
    caption: str


@dataclass(frozen=True)
class Model:
    """What became of the points."""

    points: int
    """Points of the cloud."""
    outliers: int
    """Points that were taken out as outliers."""
    vertices: int
    faces: int
    size: tuple[float, float, float] | None
    """Extent of the cloud along the world's x, y and z [m]; None without points."""


@dataclass(frozen=True, eq=False)
class ScanSummary:
    """All that a report says."""

    recorded: Recorded
    rig: Rig
    laser: int
    """Number of the laser whose stripe was followed."""
    settings: Mapping[str, Any]
    """Every setting, as plain values."""
    versions: Mapping[str, str]
    """Version of each program."""
    durations: Mapping[str, float]
    """Time that each stage took [s]."""
    pictures: Sequence[Shown]
    timeline: Timeline
    num_points: int
    """Points on all profiles."""
    signal: Spread
    """Height of the stripe above its surroundings [grey levels]."""
    depth: Spread
    """z of the points in the camera frame [m]."""
    sigma: Spread
    """Standard deviation of the points along their rays [m]."""
    along: Spread
    """Distance of neighbouring points on a stripe: along a profile [m]."""
    across: Spread
    """Distance of the same scan line's points on successive stripes: along the motion [m]."""
    model: Model
    trust: Trust | None
    """How far to trust the cloud's points; None without a cloud."""

    @property
    def num_frames(self) -> int:
        """Frames that were read."""
        return int(self.timeline.frames.sum())

    @property
    def num_empty(self) -> int:
        """Frames that were read and gave no point."""
        return int(self.timeline.empty.sum())


def summarise(
    recorded: Recorded,
    rig: Rig,
    profiles: Iterable[Profile],
    *,
    frames: FrameTimes,
    laser: int = 0,
    trajectory: Trajectory | None = None,
    cloud: PointCloud | None = None,
    num_outliers: int = 0,
    mesh: Mesh | None = None,
    settings: Mapping[str, Any],
    versions: Mapping[str, str],
    durations: Mapping[str, float] | None = None,
    pictures: Sequence[Shown] = (),
) -> ScanSummary:
    """Compute all numbers of a report.

    Args:
        recorded: What was scanned.
        rig: The rig that recorded it.
        profiles: The points, in parts of whole frames; each part is looked at once.
        frames: The frames that were read.
        laser: Number of the laser whose stripe was followed.
        trajectory: world_from_camera; without it nothing is said about spacing along the motion.
        cloud: The points in the world frame.
        num_outliers: Points that were taken out of the cloud.
        mesh: The surface.
        settings: Every setting, as plain values; may be nested.
        versions: Version of each program.
        durations: Time that each stage took [s].
        pictures: What to show, the best first.
    """
    parts, spreads = _gather(profiles, rig.lasers[laser].axis, trajectory)
    return ScanSummary(
        recorded=recorded,
        rig=rig,
        laser=laser,
        settings=settings,
        versions=versions,
        durations=durations or {},
        pictures=pictures,
        timeline=make_timeline(frames, parts),
        num_points=int(sum(part.points.sum() for part in parts)),
        model=_measure(cloud, num_outliers, mesh),
        trust=None if cloud is None or len(cloud) == 0 else judge_trust(cloud, rig),
        **spreads,
    )


def _gather(
    profiles: Iterable[Profile], axis: Axis, trajectory: Trajectory | None
) -> tuple[list[FrameStatistics], dict[str, Spread]]:
    """Look at each part once: give the statistics of its frames, and the spreads over all parts."""
    parts: list[FrameStatistics] = []
    names = ("signal", "depth", "sigma", "along", "across")
    kept: dict[str, list[np.ndarray]] = {name: [] for name in names}
    for profile in profiles:
        parts.append(frame_statistics(profile))
        kept["signal"].append(_thin(profile.signal))
        kept["depth"].append(_thin(profile.points[:, 2]))
        kept["sigma"].append(_thin(profile.sigma))
        kept["along"].append(_thin(spacing_along(profile, axis)))
        if trajectory is not None:
            kept["across"].append(_thin(spacing_across(profile, trajectory, axis)))
    return parts, {name: Spread.from_values(_join(values)) for name, values in kept.items()}


def _measure(cloud: PointCloud | None, num_outliers: int, mesh: Mesh | None) -> Model:
    num_points = 0 if cloud is None else len(cloud)
    size = None
    if cloud is not None and num_points:
        x, y, z = np.ptp(cloud.points, axis=0).tolist()
        size = (x, y, z)
    vertices, faces = (0, 0) if mesh is None else (len(mesh.vertices), len(mesh.faces))
    return Model(num_points, num_outliers, vertices, faces, size)


def _thin(values: np.ndarray) -> np.ndarray:
    return values[:: max(1, -(-len(values) // _KEPT))].astype(np.float64)


def _join(parts: list[np.ndarray]) -> np.ndarray:
    return np.concatenate([np.zeros(0), *parts])
