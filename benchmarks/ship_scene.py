"""The cruiser of `ship.py`: the drawing, the damage that the drawing does not have, and the passes.

All in the ship's frame: x aft, y to the right of one who looks ahead, z up from the water line [m].
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import trimesh
from ac3d import read_ac3d
from scipy.ndimage import gaussian_filter1d
from scipy.spatial.transform import Rotation

from murkscan import Mesh, Trajectory
from murkscan.geometry.ray_casting import RayCaster
from murkscan.types.rays import Rays

PARTS = ("hull", "propellers", "rudders")
WATER_LINE, ROUNDS = 0.3, 2
"""What begins above is left out [m]; how often triangles are cut into four."""
RATE = 25.0
"""Pictures a second."""
HUB, BLADE = np.array([4.06, -3.33]), np.array([0.95, 0.31])
"""Middle of one propeller, in y and z, and where its bent blade points."""
BENT_FROM, TIP, BENT_BY = 1.6, 2.4, 0.04
"""Radius from which the blade is bent, that of its tip, and how far aft the tip stands [m]."""
DENT, DENT_WIDTH, DENT_DEPTH = np.array([-50.0, 2.5, -6.7]), 0.5, 0.015
"""Somewhere near the middle of the dome's dent, its width and its depth [m]."""
DOME_AXIS, STANDOFF = -5.6, 1.3
"""Height of the sonar dome's axis; how far the camera stays away from the dome [m]."""
SWAY, ATTITUDE = 0.02, np.radians(0.5)
"""What waves do to the vehicle, 1σ [m, rad]: its log knows it."""
DRIFT, DRIFT_TURN = 0.015, np.radians(0.2)
"""What the log is off by from one pass to the next, 1σ an axis [m, rad]: nobody knows it."""

Passes = list[Trajectory]


@dataclass(frozen=True)
class Job:
    """One part of the ship."""

    name: str
    damage: Callable[[Mesh], Mesh]
    plan: Callable[[Mesh], Passes]


def draw_ship(model: Path) -> Mesh:
    """Give the ship below the water line, rounded, and without the wake that is drawn around it.

    The model's triangles are half a metre long: each is cut into sixteen by Loop's rule.
    """
    mesh = read_ac3d(model, PARTS)
    corners = mesh.vertices[mesh.faces]
    flat = np.ptp(corners[..., 2], axis=1) < 1e-3
    wake = flat & (np.abs(corners[..., 2].mean(axis=1)) < 0.1)
    kept = mesh.faces[(corners[..., 2].min(axis=1) < WATER_LINE) & ~wake]
    joined = trimesh.Trimesh(mesh.vertices, kept)
    joined.merge_vertices(merge_tex=True, merge_norm=True, digits_vertex=4)
    joined.update_faces(joined.unique_faces() & joined.nondegenerate_faces())
    vertices, faces = trimesh.remesh.subdivide_loop(joined.vertices, joined.faces, ROUNDS)
    astern = vertices[:, 0] > corners[corners[..., 2] < WATER_LINE, 0].max()
    faces = faces[~astern[faces].any(axis=1)]  # where triangles end, the rule throws some far off
    return drop_unused(Mesh(np.asarray(vertices), np.asarray(faces, np.int32)))


def drop_unused(mesh: Mesh) -> Mesh:
    """Leave out the vertices of no triangle."""
    used, faces = np.unique(mesh.faces, return_inverse=True)
    return Mesh(mesh.vertices[used], faces.reshape(-1, 3).astype(np.int32))


def is_bent_blade(points: np.ndarray) -> np.ndarray:
    """Tell which points are of the blade that is bent."""
    away = points[:, 1:] - HUB
    radius = np.hypot(*away.T)
    in_sector = (away @ BLADE > np.cos(np.pi / 5) * radius) & (radius < TIP + 0.2)
    return in_sector & (np.abs(points[:, 0] - 96.7) < 0.7)


def bend_blade(ship: Mesh) -> Mesh:
    """Bend the outer third of one blade aft: by nothing at its beginning, most at the tip."""
    radius = np.hypot(*(ship.vertices[:, 1:] - HUB).T)
    share = np.clip((radius - BENT_FROM) / (TIP - BENT_FROM), 0, None)
    bent = BENT_BY * share**2 * is_bent_blade(ship.vertices)
    return Mesh(ship.vertices + np.outer(bent, (1.0, 0, 0)), ship.faces)


def dent_dome(ship: Mesh) -> Mesh:
    """Push the dome in: half a wave of a cosine; its large triangles are cut up there."""
    middle, inwards = place_dent(ship)
    near = np.linalg.norm(ship.vertices[ship.faces].mean(axis=1) - middle, axis=1) < 2
    vertices, faces = trimesh.remesh.subdivide_to_size(ship.vertices, ship.faces[near], 0.02, 20)
    near_mesh, rest = Mesh(vertices, faces), drop_unused(Mesh(ship.vertices, ship.faces[~near]))
    away = near_mesh.vertices - middle
    aside = np.linalg.norm(away - np.outer(away @ inwards, inwards), axis=1)
    depth = DENT_DEPTH / 2 * (1 + np.cos(2 * np.pi * np.clip(aside / DENT_WIDTH, 0, 0.5)))
    return _join(Mesh(near_mesh.vertices + np.outer(depth, inwards), near_mesh.faces), rest)


def _join(first: Mesh, second: Mesh) -> Mesh:
    faces = [first.faces, second.faces + len(first.vertices)]
    vertices = np.concatenate([first.vertices, second.vertices])
    return Mesh(vertices, np.concatenate(faces).astype(np.int32))


def place_dent(ship: Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Give the place of the dome's skin that is pushed in most, and the direction inwards there."""
    axis = np.array([DENT[0], 0, DOME_AXIS])
    inwards = (axis - DENT) / np.linalg.norm(axis - DENT)
    caster = RayCaster(ship)
    rays = Rays((axis - 6 * inwards)[None], inwards[None])
    hits = caster.first_hits(rays)
    normal = caster.normals[hits.face[0]]
    return rays.origins[0] + hits.range[0] * inwards, normal * np.sign(normal @ inwards)


def pass_propeller(_ship: Mesh) -> Passes:
    """Look ahead from abaft, before the rudder, and sink: six times, side by side."""
    ahead = np.array([[0, 0, -1], [1, 0, 0], [0, -1, 0]], float)
    passes = []
    for number, aside in enumerate((-2.0, -1.2, -0.4, 0.4, 1.2, 2.0)):
        sinks = np.arange(-0.75, -5.9, -0.008)
        aft = 98.4 if abs(aside) < 1 else 98.0
        way = np.stack([0 * sinks + aft, 0 * sinks + HUB[0] + aside, sinks], axis=1)
        passes.append(sway(way, ahead, seed=number))
    return passes


def pass_dome(ship: Mesh) -> Passes:
    """Follow the dome aft at an even distance: five times, from its bottom up its side."""
    passes = []
    for number, angle in enumerate(np.radians((15, 37, 59, 81, 103))):
        outwards = np.array([0, np.sin(angle), -np.cos(angle)])
        x = np.arange(-54.3, -46.3, 0.01)
        axis = np.stack([x, 0 * x, 0 * x + DOME_AXIS], axis=1)
        rays = Rays(axis + 8 * outwards, np.tile(-outwards, (len(x), 1)))
        radius = gaussian_filter1d(8 - RayCaster(ship).first_hits(rays).range, 40, mode="nearest")
        down = np.array([1.0, 0, 0])
        at_dome = np.stack([np.cross(down, -outwards), down, -outwards], axis=1)
        way = axis + np.outer(radius + STANDOFF, outwards)
        passes.append(sway(way, at_dome, seed=10 + number))
    return passes


def sway(way: np.ndarray, attitude: np.ndarray, *, seed: int) -> Trajectory:
    """Let waves of some seconds push the vehicle off its way and turn it."""
    random = np.random.default_rng(seed)
    times = np.arange(len(way)) / RATE
    waves = np.array([_wave(times, random) for _ in range(6)])
    turns = Rotation.from_matrix(attitude) * Rotation.from_rotvec(ATTITUDE * waves[:3].T)
    return Trajectory(times, way + SWAY * waves[3:].T, turns.as_quat(scalar_first=True))


def _wave(times: np.ndarray, random: np.random.Generator) -> np.ndarray:
    periods, phases = random.uniform(4, 12, 5), random.uniform(0, 2 * np.pi, 5)
    return np.sin(2 * np.pi * times[:, None] / periods + phases) @ np.full(5, np.sqrt(2 / 5))


def drift(passes: Passes) -> Iterator[Trajectory]:
    """Give what the vehicle's log says of each pass: the first is right, each other is off."""
    random = np.random.default_rng(57)
    for number, true in enumerate(passes):
        shift, turn = random.normal(0, DRIFT, 3), random.normal(0, DRIFT_TURN, 3)
        off = Rotation.from_rotvec(turn * (number > 0))
        middle = true.positions.mean(axis=0)
        positions = off.apply(true.positions - middle) + middle + shift * (number > 0)
        attitudes = off * Rotation.from_quat(true.quaternions, scalar_first=True)
        yield Trajectory(true.times, positions, attitudes.as_quat(scalar_first=True))


JOBS = (
    Job("propeller", bend_blade, pass_propeller),
    Job("dome", dent_dome, pass_dome),
)
