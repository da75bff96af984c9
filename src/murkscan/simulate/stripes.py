"""Where the laser line truly lies: each scan line's ray-sheet curve meets the surface."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from ..errors import InputError
from ..optics import back_project, intersect_rays_with_sheet
from ..types.arrays import Indices, Mask, Pixels, Points, Scalars, Vector
from ..types.camera import Camera
from ..types.laser import Axis, Laser
from ..types.pose import Pose
from .base import AbstractSurface

_SAMPLE_STEP = 2
"""Pixels from one sample of a scan line to the next while looking for the surface."""
_HALVINGS = 40
"""Bisections of one such step: they leave 2e-12 px."""
_SHADOW_SAMPLES = 40
"""Points on a light path that are tried for being inside the object."""

Grid = Float[np.ndarray, "lines samples"]
PointGrid = Float[np.ndarray, "lines samples 3"]


@dataclass(frozen=True, eq=False)
class ScanLines:
    """The scan lines of one laser, sampled from near to far."""

    camera: Camera
    laser: Laser
    positions: Scalars
    """Coordinates along every scan line [px], those that see the sheet nearer first."""
    points: PointGrid
    """Where the rays of those pixels meet the sheet, in the camera frame [m]."""


@dataclass(frozen=True, eq=False)
class Crossings:
    """Where the sheet's middle is seen on the surface in one frame; one a row."""

    lines: Indices
    """Number of the scan line: the column where the laser's axis is y, otherwise the row."""
    positions: Scalars
    """True centre along the scan line [px]."""
    points: Points
    """The same in space, in the camera frame [m]."""


def trace_scan_lines(camera: Camera, laser: Laser) -> ScanLines:
    """Meet the laser's sheet along every scan line; the same for all frames.

    Raises:
        InputError: The rig has a port, or the sheet contains the optical centre and is seen
            edge-on.
    """
    if camera.port is not None:
        raise InputError("This simulation is in air: give a rig without ports.")
    if laser.as_plane().distance == 0:
        raise InputError(
            "The laser's sheet passes through the camera's optical centre, so it measures nothing. "
            "Give the rig a baseline."
        )
    num_lines, length = camera.size if laser.axis == "y" else camera.size[::-1]
    positions = np.arange(0.0, length, _SAMPLE_STEP)
    baseline, _ = laser.as_baseline_angle()
    if baseline < 0:  # A laser on the other side: the far end of its sheet is at the low pixels.
        positions = positions[::-1]
    lines = np.repeat(np.arange(num_lines), len(positions))
    points = meet_sheet(camera, laser, as_pixels(laser.axis, lines, np.tile(positions, num_lines)))
    return ScanLines(camera, laser, positions, points.reshape(num_lines, len(positions), 3))


def find_crossings(
    surface: AbstractSurface, world_from_camera: Pose, scan_lines: ScanLines
) -> Crossings:
    """Find the true centre of the stripe in every scan line that shows it.

    Where a scan line meets the surface more than once, the nearest meeting counts. It is left out
    where the surface itself hides it from the camera or from the laser, which is taken to stand
    where its sheet cuts the camera's axis.
    """
    lines, first = _bracket(_depth_behind(surface, world_from_camera, scan_lines.points))
    near, far = scan_lines.positions[first], scan_lines.positions[first + 1]
    for _ in range(_HALVINGS):
        middle = (near + far) / 2
        points = world_from_camera @ _points_at(scan_lines, lines, middle)
        is_in_front = points[:, 2] < surface.depth(points[:, 0], points[:, 1])
        near, far = np.where(is_in_front, middle, near), np.where(is_in_front, far, middle)
    positions = (near + far) / 2
    points = _points_at(scan_lines, lines, positions)
    seen = _is_unhidden(surface, world_from_camera, points, np.zeros(3))
    seen &= _is_unhidden(surface, world_from_camera, points, laser_position(scan_lines.laser))
    return Crossings(lines[seen], positions[seen], points[seen])


def meet_sheet(camera: Camera, laser: Laser, pixels: Pixels) -> Points:
    """Give the point of the sheet that each pixel sees [m]; NaN where it sees none."""
    return intersect_rays_with_sheet(back_project(camera, pixels), laser)


def laser_position(laser: Laser) -> Vector:
    """Give where the laser is taken to stand: where its sheet cuts the camera's axis [m]."""
    baseline, _ = laser.as_baseline_angle()
    return np.where(np.array(["x", "y", "z"]) == laser.axis, -baseline, 0.0)


def as_pixels(axis: Axis, lines: Indices, positions: Scalars) -> Pixels:
    """Give u and v [px] of a coordinate along each of these scan lines."""
    columns = (lines.astype(float), positions) if axis == "y" else (positions, lines.astype(float))
    return np.stack(columns, axis=1)


def _points_at(scan_lines: ScanLines, lines: Indices, positions: Scalars) -> Points:
    pixels = as_pixels(scan_lines.laser.axis, lines, positions)
    return meet_sheet(scan_lines.camera, scan_lines.laser, pixels)


def _depth_behind(surface: AbstractSurface, world_from_camera: Pose, points: PointGrid) -> Grid:
    """How far each point lies behind the surface [m]; NaN where there is no surface before it."""
    x, y, z = (world_from_camera @ points.reshape(-1, 3)).T
    low, high = surface.box()
    behind = np.full(len(x), np.nan)
    near = np.flatnonzero((x >= low[0]) & (x <= high[0]) & (y >= low[1]) & (y <= high[1]))
    near = near[surface.covers(x[near], y[near])]
    # Beyond the box the sign is enough, and most points are there.
    behind[near] = np.where(z[near] < low[2], z[near] - low[2], z[near] - high[2])
    near = near[(z[near] >= low[2]) & (z[near] <= high[2])]
    behind[near] = z[near] - surface.depth(x[near], y[near])
    return behind.reshape(points.shape[:2])


def _bracket(behind: Grid) -> tuple[Indices, Indices]:
    """Find the scan lines that pass from before the surface to behind it, and the sample before."""
    passes: Bool[np.ndarray, "lines steps"] = (behind[:, :-1] < 0) & (behind[:, 1:] >= 0)
    lines = np.flatnonzero(passes.any(axis=1))
    return lines, passes[lines].argmax(axis=1)


def _is_unhidden(
    surface: AbstractSurface, world_from_camera: Pose, points: Points, source: Vector
) -> Mask:
    """Tell which points [m] a straight path from the source reaches; all in the camera frame."""
    # The object is far from the rig: most of the way is free, its last third is looked at.
    share = np.linspace(0.65, 1.0, _SHADOW_SAMPLES, endpoint=False)
    paths = source + share[None, :, None] * (points - source)[:, None, :]
    depths = _depth_behind(surface, world_from_camera, paths)
    return np.count_nonzero(depths > 1e-9, axis=1) == 0
