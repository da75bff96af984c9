"""Heights of what lay on the stage, above the plane of the bed in the same scan.

The camera looks straight down on the bed, and the rail that carries it leans by 1.7 degrees: the
bed recedes by a millimetre along the travel. So it is a plane of depth over travel and row, and a
height is what is missing to it along the camera's axis, in the same frame. (Where the travel is
taken to be along the camera's x instead, so that the bed itself leans, all heights are too large by
the bed's slope times the parallax: 0.1 mm on the stairs, 0.3 mm on the third level.)
"""

from dataclasses import dataclass

import numpy as np
from real_sets import Shot
from stairs import BED, PLATEAUS, TRUTH_MM

from murkscan import Stripe
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
    if shot.name not in LEVELS or not len(stripe):
        return []
    profile = triangulate(stripe, shot.rig, RaySheet())
    travel = _STEP * profile.frame.astype(float)
    points = np.stack([travel, profile.points[:, 1], profile.points[:, 2]], axis=1)
    rows = np.rint(profile.pixels[:, 1])
    bed = np.logical_or.reduce([(low <= rows) & (rows < high) for low, high in _BEDS[shot.name]])
    plane = fit_plane(points[bed]).plane
    heights = -plane.distance_to(points) / plane.normal[2] * 1e3
    return [_measure(level, heights, profile.frame, rows) for level in LEVELS[shot.name]]


def _measure(level: Level, heights: np.ndarray, frames: np.ndarray, rows: np.ndarray) -> Height:
    low, high = level.rows
    top = heights[np.isin(frames, level.frames) & (low <= rows) & (rows < high)]
    if not len(top):
        return Height(level, np.nan, np.nan)
    middle = float(np.median(top))
    return Height(level, middle, float(np.median(np.abs(top - middle))))
