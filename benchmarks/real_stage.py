"""Heights of what lay on the stage, above the plane of the bed in the same scan."""

from dataclasses import dataclass

import numpy as np
from real_sets import Shot
from stairs import BED, PLATEAUS, TRUTH_MM

from murkscan import ConstantStep, PointCloud, Stripe
from murkscan.cloud import merge_profiles
from murkscan.geometry import fit_plane
from murkscan.triangulate import RaySheet, triangulate

_STEP = 1e-3
"""Travel between two frames [m]."""


@dataclass(frozen=True)
class Level:
    """A flat top of known height, and where the scan shows it."""

    caliper: float
    """Height above the bed by caliper [mm]."""
    frames: range
    rows: tuple[int, int]


LEVELS = {
    "stage_stairs": tuple(
        Level(float(truth), frames, rows)
        for truth, (frames, rows) in zip(TRUTH_MM, PLATEAUS, strict=True)
    ),
    "stage_three_levels": (
        Level(2.35, range(0, 1), (180, 320)),
        Level(20.10, range(10, 18), (140, 335)),
        Level(24.82, range(22, 30), (140, 335)),
    ),
}
_BEDS = {"stage_stairs": BED, "stage_three_levels": ((0, 110), (365, 480))}
"""Image rows that show the bed in every frame."""


@dataclass(frozen=True)
class Height:
    """One top as a finder's points have it [mm]."""

    level: Level
    height: float
    scatter: float
    """Median absolute deviation from that height."""

    def __str__(self) -> str:
        """Tell it in a line."""
        return (
            f"{self.level.caliper:.2f} mm by caliper: {self.height:.2f}, "
            f"off by {self.height - self.level.caliper:+.2f}, scatter (MAD) {self.scatter:.3f}"
        )


def stage_heights(shot: Shot, stripe: Stripe) -> list[Height]:
    """Measure the tops of a stage scan; none where their heights are not known."""
    if shot.name not in LEVELS:
        return []
    cloud = _cloud(shot, stripe)
    rows = cloud.scan_line
    bed = np.logical_or.reduce([(low <= rows) & (rows < high) for low, high in _BEDS[shot.name]])
    plane = fit_plane(cloud.points[bed]).plane
    heights = -np.sign(plane.normal[2]) * plane.distance_to(cloud.points) * 1e3
    found = []
    for level in LEVELS[shot.name]:
        low, high = level.rows
        top = heights[np.isin(cloud.frame, level.frames) & (low <= rows) & (rows < high)]
        middle = float(np.median(top)) if len(top) else np.nan
        scatter = float(np.median(np.abs(top - middle))) if len(top) else np.nan
        found.append(Height(level, middle, scatter))
    return found


def _cloud(shot: Shot, stripe: Stripe) -> PointCloud:
    times = np.arange(float(stripe.frame.max(initial=0)) + 1)
    trajectory = ConstantStep(_STEP, "x").follow(times, times)
    return merge_profiles(triangulate(stripe, shot.rig, RaySheet()), trajectory, axis="x")
