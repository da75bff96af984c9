"""A leg: what one laser saw while the vehicle went one way, cut into facets.

A leg sees each place once, so two legs that see the same place say how the vehicle moved between::

        sheet 0  ───────▶  leg 0    facets of a few profiles × a few scan lines
        sheet 1  ───────▶  leg 1    the same places, a second earlier
        sheet 0  ◀───────  leg 2    the next pass, over its edge
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from ..._kernels.facets import fit_facets, sum_cells
from ...types.arrays import Directions, Indices, Points, Scalars, SmallNumbers, Vector
from ...types.navigation import Navigation
from ...types.trajectory import Trajectory
from .path import Path, Poses

_JUMP = 3.0
"""Cells' sizes that the middles of neighbouring cells of one surface may lie apart."""
_NEIGHBOURS = 1
"""Cells to each side whose points make a plane."""
_FEWEST_ROWS = 4
"""Rows of cells below which a leg shows nothing."""


@dataclass(frozen=True, eq=False)
class Pass:
    """Profiles of one recording, and the log of its vehicle."""

    times: Float[np.ndarray, " p"]
    """When each profile was taken, by the recording's clock [s], strictly increasing."""
    profile: Indices
    """Number of each point's profile."""
    line: Indices
    """Number of each point's scan line, from 0."""
    laser: SmallNumbers
    """Number of each point's laser."""
    points: Points
    """Points in the vehicle's frame [m]: carried by the mount."""
    bright: Scalars
    """Brightness of the stripe at each point."""
    navigation: Navigation
    start: Trajectory | None = None
    """world_from_vehicle at `times` where registration has laid the pass, from which it is
    adjusted; None: where its log says."""


@dataclass(frozen=True, eq=False)
class Leg:
    """Points of one leg in cells of its own grid."""

    number: int
    """Of its pass."""
    laser: int
    points: Points
    profile: Indices
    cell: Indices
    bright: Scalars
    times: Float[np.ndarray, " p"]
    """Of all profiles of the pass [s]."""
    row_times: Float[np.ndarray, " r"]
    """Mean time of each row of cells [s]."""
    row_points: Float[np.ndarray, "r 3"]
    """Mean of the leg's points, a row [m], in the vehicle's frame: where it looked."""
    num_columns: int
    size: float
    """Of a cell [m]."""
    slant: Vector
    """Unit direction in the vehicle's frame, within the sheet, along which a point moves that lies
    farther away."""


@dataclass(frozen=True, eq=False)
class Facets:
    """Plane pieces of a leg where the paths lay when they were made."""

    leg: Leg
    row: Indices
    """Row of cells of each, which gives its time."""
    column: Indices
    """Column of cells of each."""
    own: Points
    """Middle in the vehicle's frame at that time [m]."""
    points: Points
    """Middle in the world [m]."""
    normals: Directions
    """Towards the sensor, in the world."""
    axes: Float[np.ndarray, "n 2 3"]
    """Two axes across the line of sight, along which slopes count."""
    slants: Directions
    """Directions of `Leg.slant` in the world."""
    slope_variance: Float[np.ndarray, "n 2"]
    """Variance of the plane's slope along them."""
    variance: Scalars
    """Mean square distance of the points from the plane [m²]."""
    count: Scalars
    """Points of the cell itself."""
    bright: Scalars
    """Mean brightness there."""

    def __len__(self) -> int:
        """Count the facets."""
        return len(self.row)


def cut_legs(number: int, one: Pass, path: Path, cell: float) -> list[Leg]:
    """Cut a pass into legs.

    Args:
        number: Of the pass.
        one: The pass.
        path: Its way so far: where it turns, a leg ends.
        cell: Size of a facet [m].
    """
    legs = []
    for first, last in _straight_stretches(one.times, path):
        for laser in np.unique(one.laser):
            mine = (one.laser == laser) & (one.profile >= first) & (one.profile < last)
            leg = _make_leg(number, int(laser), one, np.flatnonzero(mine), path, cell)
            if leg is not None:
                legs.append(leg)
    return legs


def _straight_stretches(times: Scalars, path: Path) -> list[tuple[int, int]]:
    """Give ranges of profiles within which the vehicle does not turn back."""
    smooth = max(int(2.0 / max(float(np.median(np.diff(times))), 1e-6)), 1)
    velocity = path.velocity(times)
    window = np.ones(smooth) / smooth
    velocity = np.stack([np.convolve(v, window, mode="same") for v in velocity.T], axis=1)
    stretches, first, direction = [], 0, velocity[0]
    for i in range(len(times)):
        direction = velocity[first : i + 1].sum(axis=0) if i - first < smooth else direction
        if velocity[i] @ direction < 0:
            stretches.append((first, i))
            first, direction = i, velocity[i]
    return [*stretches, (first, len(times))]


def _make_leg(
    number: int, laser: int, one: Pass, which: Indices, path: Path, size: float
) -> Leg | None:
    if len(which) == 0:
        return None
    profile, line, points = one.profile[which], one.line[which], one.points[which]
    poses = path.at(one.times)
    profiles_a_row = max(round(size / _profile_spacing(profile, points, poses)), 1)
    lines_a_column = max(round(size / _line_spacing(profile, line, points)), 1)
    row = (profile - profile.min()) // profiles_a_row
    column = (line - line.min()) // lines_a_column
    rows, columns = int(row.max()) + 1, int(column.max()) + 1
    if rows < _FEWEST_ROWS:
        return None
    count = np.bincount(row, minlength=rows)
    held = np.maximum(count, 1)
    times = np.bincount(row, one.times[profile], minlength=rows) / held
    middle = (np.arange(rows) + 0.5) * profiles_a_row + profile.min()
    empty = np.interp(middle, np.arange(len(one.times)), one.times)
    seen = np.stack([np.bincount(row, p, minlength=rows) for p in points.T], axis=1)
    spacing = _profile_spacing(profile, points, poses) * profiles_a_row
    return Leg(
        number,
        laser,
        points,
        profile,
        row * columns + column,
        one.bright[which],
        one.times,
        np.where(count > 0, times, empty),
        seen / held[:, None],
        columns,
        max(size, spacing, _line_spacing(profile, line, points) * lines_a_column),
        _find_slant(line - line.min(), points),
    )


def _find_slant(line: Indices, points: Points) -> Vector:
    """Give along which direction the points of a scan line lie, whatever their distance."""
    count = np.maximum(np.bincount(line), 1)
    mean = np.stack([np.bincount(line, p) for p in points.T], axis=1) / count[:, None]
    off = points - mean[line]
    return np.asarray(np.linalg.eigh(off.T @ off)[1][:, -1])


def _profile_spacing(profile: Indices, points: Points, poses: Poses) -> float:
    """Give the usual distance of one profile from the next on the surface [m]."""
    middle = points.mean(axis=0)
    at = poses.rotations @ middle + poses.positions
    steps = np.linalg.norm(np.diff(at[np.unique(profile)], axis=0), axis=1)
    return max(float(np.median(steps)), 1e-5) if len(steps) else 1.0


def _line_spacing(profile: Indices, line: Indices, points: Points) -> float:
    next_to = (np.diff(profile) == 0) & (np.diff(line) == 1)
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)[next_to]
    return max(float(np.median(steps)), 1e-5) if len(steps) else 1.0


def make_facets(leg: Leg, path: Path) -> Facets:
    """Fit the facets of a leg where its path lies now."""
    poses, rows = path.at(leg.times), path.at(leg.row_times)
    origin = poses.positions[leg.profile[0]]
    num_rows = len(leg.row_times)
    sums = sum_cells(
        leg.points,
        leg.profile,
        leg.cell,
        leg.bright,
        poses.rotations,
        poses.positions - origin,
        num_rows * leg.num_columns,
    )
    frames = _sight_axes(leg, rows, leg_direction(path, leg.row_times))
    planes, middle = fit_facets(
        sums, num_rows, leg.num_columns, frames, _NEIGHBOURS, _JUMP * leg.size
    )
    good = np.flatnonzero(np.isfinite(planes[:, 0]))
    row, planes = good // leg.num_columns, planes[good]
    points = middle[good, :3] + origin
    axes = frames[row, :2]
    away = points - rows.positions[row]
    return Facets(
        leg,
        row,
        good % leg.num_columns,
        np.einsum("nji,nj->ni", rows.rotations[row], away),
        points,
        planes[:, :3],
        axes,
        (rows.rotations @ leg.slant)[row],
        planes[:, 3:5],
        planes[:, 5],
        sums[good, 0],
        middle[good, 3],
    )


def leg_direction(path: Path, times: Scalars) -> Vector:
    """Give the unit direction from where a leg begins to where it ends, in the world."""
    first, last = path.at(times[[0, -1]]).positions
    length = float(np.linalg.norm(last - first))
    return (last - first) / length if length else np.array([1.0, 0.0, 0.0])


def _sight_axes(leg: Leg, rows: Poses, forward: Vector) -> Float[np.ndarray, "r 3 3"]:
    """Give two axes across the line of sight of each row, and the one towards the sensor."""
    towards = -np.einsum("nij,nj->ni", rows.rotations, leg.row_points)
    towards /= np.maximum(np.linalg.norm(towards, axis=1, keepdims=True), 1e-12)
    side = np.cross(towards, forward)
    side /= np.maximum(np.linalg.norm(side, axis=1, keepdims=True), 1e-12)
    return np.stack([np.cross(side, towards), side, towards], axis=1)
