"""Where the middle of the sheet truly lies on the surface, as the camera sees it.

The fan's rays are cast at the mesh and their hits are seen by the camera; between two hits that
stand on both sides of a scan line lies a centre. It is then found to rounding: the ray of the scan
line that meets the sheet where it also meets a triangle's plane.
"""

from dataclasses import dataclass, fields

import numpy as np

from ..geometry.ray_casting import RayCaster
from ..optics.beam import Beam
from ..optics.scan_lines import SheetScanLines
from ..types.arrays import Indices, Mask, Points, Scalars
from ..types.pose import Pose
from ..types.rays import Rays

_RAYS_A_LINE = 3
"""Rays of the fan for each scan line: more than one between two of them, also at the sides."""
WIDEST = 40.0
"""Scan lines between two neighbouring rays' hits, above which they are taken as a gap."""
_ROUNDS = 4
"""Times that the triangle under a centre is looked up again."""
_STEPS = 3
"""Secant steps on one triangle's plane; ray and sheet make it nearly linear."""
_TRUE = 1e-7
"""A centre lies on the surface and on the sheet to this [m]."""
_SAME = 0.02
"""Centres of one scan line that are nearer than this are one [px]."""


@dataclass(frozen=True, eq=False)
class LitLine:
    """The sheet's middle on the surface in one frame; one place a row."""

    lines: Indices
    """Number of the scan line."""
    positions: Scalars
    """Coordinate along it [px]."""
    points: Points
    """The same on the surface, in the camera frame [m]."""
    face: Indices
    """Number of the triangle."""

    def __len__(self) -> int:
        """Count the places."""
        return len(self.lines)

    def __getitem__(self, which: Mask | Indices) -> "LitLine":
        """Pick some of the places."""
        return LitLine(*(getattr(self, column.name)[which] for column in fields(self)))


@dataclass(frozen=True, eq=False)
class Fall:
    """How far the fan's rays go before they meet a surface."""

    angles: Scalars
    """Angles of the rays, increasing [rad]."""
    rays: Rays
    """The rays, in the camera frame."""
    ranges: Scalars
    """How far each goes from its start [m]; infinite where it meets nothing."""
    face: Indices
    """The triangle that it meets; -1 where there is none."""

    def is_lit(self, angles: Scalars, ranges: Scalars) -> Mask:
        """Tell which places of the sheet light reaches, from the nearest ray."""
        step = (self.angles[-1] - self.angles[0]) / (len(self.angles) - 1)
        nearest = np.rint((angles - self.angles[0]) / step)
        inside = (nearest >= 0) & (nearest < len(self.angles)) & np.isfinite(ranges)
        return inside & (ranges <= self.ranges[np.where(inside, nearest, 0).astype(int)])


@dataclass(frozen=True, eq=False)
class Crossings:
    """Where a line of points crosses scan lines; one a row."""

    lines: Indices
    """Number of the scan line."""
    positions: Scalars
    """Coordinate along it [px]."""
    before: Indices
    """Number of the point before the crossing."""
    share: Scalars
    """Share of the way from there to the next point."""


def to_world(rays: Rays, world_from_camera: Pose) -> Rays:
    """Carry rays from the camera frame to the world frame."""
    away = rays.directions @ world_from_camera.rotation.T
    return Rays(world_from_camera @ rays.origins, away)


def cast_fan(beam: Beam, scan_lines: SheetScanLines, caster: RayCaster, pose: Pose) -> Fall:
    """Follow the fan's rays to the surface; the pose is world_from_camera."""
    count = _RAYS_A_LINE * scan_lines.count
    angles = np.linspace(-beam.fan.half_angle, beam.fan.half_angle, count)
    rays = beam.rays(angles)
    hits = caster.first_hits(to_world(rays, pose))
    return Fall(angles, rays, hits.range, hits.face)


def find_lit_line(
    beam: Beam, scan_lines: SheetScanLines, caster: RayCaster, pose: Pose, fall: Fall
) -> LitLine:
    """Find the true centres that the camera sees; the pose is world_from_camera."""
    met = np.flatnonzero(fall.face >= 0)
    hits = fall.rays.origins[met] + fall.ranges[met, None] * fall.rays.directions[met]
    crossings = cross_scan_lines(scan_lines, met, hits)
    face = fall.face[met[crossings.before]]
    found = _settle(scan_lines, caster, pose, crossings.lines, crossings.positions, face)
    found = found[_is_seen(beam, scan_lines, caster, pose, found)]
    return _keep_one_of_same(found)


def cross_scan_lines(scan_lines: SheetScanLines, number: Indices, points: Points) -> Crossings:
    """Find between which of a line's points it crosses each scan line, and where.

    Args:
        scan_lines: The scan lines.
        number: Numbers of the points, increasing; the line has a gap where one is missing.
        points: The points, in the camera frame [m].
    """
    across, along = scan_lines.project(points)
    low, high = np.minimum(across[:-1], across[1:]), np.maximum(across[:-1], across[1:])
    joined = (np.diff(number) == 1) & (high - low < WIDEST)
    first = np.clip(np.ceil(np.nan_to_num(low)), 0, scan_lines.count).astype(int)
    last = np.clip(np.floor(np.nan_to_num(high)), -1, scan_lines.count - 1).astype(int)
    times = np.where(joined, np.maximum(last - first + 1, 0), 0)
    which = np.repeat(np.arange(len(times)), times)
    lines = first[which] + np.arange(len(which)) - np.repeat(np.cumsum(times) - times, times)
    run = across[which + 1] - across[which]
    share = (lines - across[which]) / np.where(run == 0, 1.0, run)
    positions = along[which] + share * (along[which + 1] - along[which])
    return Crossings(lines, positions, which, share)


def _settle(
    scan_lines: SheetScanLines,
    caster: RayCaster,
    pose: Pose,
    lines: Indices,
    positions: Scalars,
    face: Indices,
) -> LitLine:
    """Move each centre along its scan line to where the sheet meets the triangle seen there."""
    for _ in range(_ROUNDS):
        positions = _meet_planes(scan_lines, caster, pose, lines, positions, face)
        seen = caster.first_hits(to_world(scan_lines.rays(lines, positions), pose)).face
        changed = (seen >= 0) & (seen != face)
        face = np.where(changed, seen, face)
        if not changed.any():
            break
    points = scan_lines.meet_sheet(scan_lines.rays(lines, positions))
    return LitLine(lines, positions, points, face)


def _meet_planes(
    scan_lines: SheetScanLines,
    caster: RayCaster,
    pose: Pose,
    lines: Indices,
    positions: Scalars,
    face: Indices,
) -> Scalars:
    """Find, by the secant method, where the sheet along each scan line meets a triangle's plane."""

    def height(at: Scalars) -> Scalars:
        points = scan_lines.meet_sheet(scan_lines.rays(lines, at))
        return caster.height_above(pose @ points, face)

    before, now = positions, positions + 0.1
    height_before, height_now = height(before), height(now)
    for _ in range(_STEPS):
        rise = height_now - height_before
        with np.errstate(divide="ignore", invalid="ignore"):
            step = np.where(rise == 0, 0.0, -height_now * (now - before) / rise)
        before, height_before = now, height_now
        now = now + np.clip(step, -WIDEST, WIDEST)
        height_now = height(now)
    return now


def _is_seen(
    beam: Beam, scan_lines: SheetScanLines, caster: RayCaster, pose: Pose, found: LitLine
) -> Mask:
    """Tell which centres lie on the surface, in the picture, in light and in sight."""
    length = scan_lines.camera.size["xy".index(scan_lines.laser.axis)]
    true = np.abs(caster.height_above(pose @ found.points, found.face)) < _TRUE
    true &= (found.positions > -0.5) & (found.positions < length - 0.5)
    seen_along = scan_lines.rays(found.lines, found.positions)
    away = np.linalg.norm(found.points - seen_along.origins, axis=1)
    where = beam.locate(found.points)
    lit_along = beam.rays(np.nan_to_num(where.angle))
    free = caster.is_free(to_world(seen_along, pose), away)
    free &= caster.is_free(to_world(lit_along, pose), where.range)
    normals = caster.normals[found.face] @ pose.rotation
    sides = [np.einsum("ij,ij->i", normals, r.directions) for r in (seen_along, lit_along)]
    return true & free & (sides[0] * sides[1] > 0) & _is_on_face(caster, pose, found)


def _is_on_face(caster: RayCaster, pose: Pose, found: LitLine) -> Mask:
    """Tell which centres lie within their triangle, or at most a rounding beyond its edge."""
    corners = caster.mesh.vertices[caster.mesh.faces[found.face]]
    normal, at = caster.normals[found.face], pose @ found.points
    inside = np.ones(len(found), bool)
    for i in range(3):
        edge = corners[:, (i + 1) % 3] - corners[:, i]
        inward = np.cross(normal, edge)
        inward /= np.maximum(np.linalg.norm(inward, axis=1, keepdims=True), 1e-300)
        inside &= np.einsum("ij,ij->i", at - corners[:, i], inward) > -1e-6
    return inside


def _keep_one_of_same(found: LitLine) -> LitLine:
    """Sort by scan line and place, and keep one of those that were found twice."""
    found = found[np.lexsort([found.positions, found.lines])]
    again = (np.diff(found.lines) == 0) & (np.diff(found.positions) < _SAME)
    return found[np.concatenate([[True], ~again])[: len(found)]]
