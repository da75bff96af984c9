"""All numbers of a report, in metres and seconds."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..types.cloud import PointCloud
from ..types.frame_times import FrameTimes
from ..types.profile import Profile
from ..types.rig import Rig
from ..types.trajectory import Trajectory
from .belief import Belief
from .calibrated import CalibrationStep, read_steps
from .coverage import Coverage, map_coverage
from .directions import SurfaceDirections
from .gathering import gather, measure_cloud
from .histogram import Histogram
from .quantiles import Quantiles
from .reach import Reach
from .recorded import ModelSize, Recorded, Shown
from .speed import Speed, judge_speed
from .swath_layout import SwathLayout
from .timeline import Timeline, make_timeline
from .trust import Trust


@dataclass(frozen=True, eq=False)
class ScanSummary:
    """All that a report says."""

    recorded: Recorded
    rig: Rig
    lasers: tuple[int, ...]
    """Numbers of the lasers whose stripes were followed."""
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
    signal: Quantiles
    """Height of the stripe above its surroundings [grey levels]."""
    depth: Quantiles
    """z of the points in the camera frame [m]."""
    sigma: Quantiles
    """Standard deviation of the points along their rays [m]."""
    along: Quantiles
    """Distance of neighbouring points on a stripe: along a profile [m]."""
    across: Quantiles
    """Distance of the same scan line's points on successive stripes: along the motion [m]."""
    model: ModelSize
    trust: Trust | None
    """How far to trust the cloud's points; None without a cloud."""
    duration: float
    """From the first frame to the last [s]; in pictures where the recording has no times."""
    signals: Histogram
    sigmas: Histogram
    """How signal [grey levels] and sigma [m] are spread over the points."""
    reach: Reach
    """How the stripe fades with range."""
    belief: Belief
    """How sure the extractor was of the points."""
    wanted: float | None
    """Spacing of the points that was asked for [m]; None where none was."""
    speed: Speed | None
    """None where there is no motion to judge."""
    steps: Sequence[CalibrationStep]
    """What the rig's file says of its calibration."""
    coverage: Coverage | None = None
    """Which parts of the surface the scan has; see `with_coverage`."""

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
    lasers: Sequence[int] = (0,),
    trajectory: Trajectory | None = None,
    cloud: PointCloud | Iterable[PointCloud] | None = None,
    num_outliers: int = 0,
    mesh_size: tuple[int, int] = (0, 0),
    wanted: float | None = None,
    noise: float = 0.0,
    settings: Mapping[str, Any],
    versions: Mapping[str, str],
    durations: Mapping[str, float] | None = None,
    pictures: Sequence[Shown] = (),
) -> ScanSummary:
    """Compute all numbers of a report but those of `with_coverage`.

    Args:
        recorded: What was scanned.
        rig: The rig that recorded it.
        profiles: The points, in parts of whole frames; each part is looked at once.
        frames: The frames that were read.
        lasers: Numbers of the lasers whose stripes were followed.
        trajectory: world_from_camera; without it nothing is said about spacing along the motion.
        cloud: The points in the world frame, all at once or in blocks.
        num_outliers: Points that were taken out of the cloud.
        mesh_size: Vertices and triangles of the surface.
        wanted: Wanted spacing of the points [m]; None: gaps are judged by the scan's own, the
            speed by that along the stripe.
        noise: Standard deviation of a pixel [grey levels], 0 where it is not known.
        settings: Every setting, as plain values; may be nested.
        versions: Version of each program.
        durations: Time that each stage took [s].
        pictures: What to show, the best first.
    """
    gathered = gather(profiles, {n: rig.lasers[n].axis for n in lasers}, trajectory)
    values = dict(gathered.values)
    reach = Reach.from_points(values.pop("range"), values["signal"], noise=noise)
    spreads = {name: Quantiles.from_values(numbers) for name, numbers in values.items()}
    model, trust = measure_cloud(
        cloud,
        num_outliers,
        mesh_size,
        is_stated=bool(rig.covariance.names)
        or (trajectory is not None and trajectory.errors is not None),
    )
    needed = wanted if wanted is not None else spreads["along"].median
    return ScanSummary(
        recorded=recorded,
        rig=rig,
        lasers=tuple(lasers),
        settings=settings,
        versions=versions,
        durations=durations or {},
        pictures=pictures,
        timeline=make_timeline(frames, gathered.parts),
        num_points=int(sum(part.points.sum() for part in gathered.parts)),
        model=model,
        trust=trust,
        duration=float(np.ptp(frames.time)) if len(frames) else 0.0,
        signals=Histogram.from_values(values["signal"]),
        sigmas=Histogram.from_ratios(values["sigma"]),
        reach=reach,
        belief=gathered.belief,
        wanted=wanted,
        speed=None
        if trajectory is None
        else judge_speed(frames, trajectory, is_timed=recorded.is_timed, wanted=needed),
        steps=read_steps(recorded.calibration or {}, recorded=recorded.date),
        coverage=None,
        **spreads,
    )


def with_coverage(
    summary: ScanSummary,
    profiles: Iterable[Profile],
    *,
    frames: FrameTimes,
    trajectory: Trajectory,
) -> ScanSummary:
    """Add the map of what the scan has and misses, for which the spacing has to be known first.

    Args:
        summary: All else that is known of the scan.
        profiles: The points once more, in parts of whole frames in order.
        frames: The frames that were read.
        trajectory: world_from_camera.
    """
    spacing = max(summary.along.median or 0.0, summary.across.median or 0.0)
    if summary.speed is None or not spacing:
        return summary
    axes = {number: summary.rig.lasers[number].axis for number in summary.lasers}
    directions = SurfaceDirections.from_trajectory(trajectory, axes[summary.lasers[0]])
    layouts = {
        number: SwathLayout(
            frames,
            trajectory,
            axis,
            summary.recorded.size,
            summary.recorded.fields_per_picture,
            directions,
        )
        for number, axis in axes.items()
    }
    wanted = summary.wanted or spacing
    coverage = map_coverage(profiles, layouts, reach=summary.reach, wanted=wanted, spacing=spacing)
    return replace(summary, coverage=coverage)
