"""Photographs of boards and of the laser's line on them, rendered, with what is true of each."""

import math
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from murkscan.calibrate import Margin
from murkscan.calibrate.adjust.observations import Sighting, index_of
from murkscan.io.parquet import load_true_stripe
from murkscan.optics import project
from murkscan.simulate import Body, Light, Scene, Sensor
from murkscan.simulate.shapes import Chessboard, Plane
from murkscan.simulate.textures import Checkered, Plain
from murkscan.survey.simulate import simulate_recording
from murkscan.types.pose import Pose
from murkscan.types.rig import Rig
from murkscan.types.trajectory import Trajectory

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from tests.calibrate import underwater
from tests.calibrate.boards import BOARD

SENSOR = Sensor(full_well=9000.0, read_noise=9.0, bits=8, psf=0.8)
PRINT = Checkered(BOARD.columns, BOARD.rows, BOARD.square)
PAPER, PAPER_BY_LASER = 180.0, 40.0
"""Grey levels above black of white paper in mid-picture: in photos of boards, of stripes."""
NO_MARGIN = Margin(0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True, eq=False)
class Photographs:
    """Photos of the board, rendered, with what is true of each."""

    folder: Path
    """Where the pictures lie."""
    truths: Mapping[str, Sighting]
    """The true corners, board and stripe, by the name of the picture."""
    crlb: Mapping[str, np.ndarray]
    """Least standard deviation of each stripe centre [px]."""


def photograph_all(
    rig: Rig, count: int, out: Path, *, power: float, seed: int
) -> tuple[Photographs, Photographs, Photographs]:
    """Render boards in air, boards through the port, and boards with the laser's line on them."""
    random = np.random.default_rng(seed)
    air = replace(rig, camera=replace(rig.camera, port=None), water=None, lasers=())
    dark = replace(rig, lasers=())
    in_air, in_water = (hold_boards(random, one, count, 0.4, 1.6) for one in (air, rig))
    on_line = hold_boards(random, rig, count, 0.45, 2.0, is_lit)
    return (
        photograph(air, in_air, out / "air", seed=3 * seed),
        photograph(dark, in_water, out / "water", seed=3 * seed + 1),
        photograph(rig, on_line, out / "laser", seed=3 * seed + 2, power=power),
    )


def hold_boards(
    random: np.random.Generator,
    rig: Rig,
    count: int,
    near: float,
    far: float,
    fits: Callable[[Rig, Pose], bool] = lambda rig, pose: True,
) -> list[Pose]:
    """Hold the board in many ways, with all of its squares in view."""
    outline = BOARD.outline(NO_MARGIN)
    poses = list[Pose]()
    while len(poses) < count:
        pose = underwater.hold_board(random, rig, near, far)
        seen = project(rig.camera, pose @ outline, index_of(rig))
        if np.all((seen > 0) & (seen < np.array(rig.camera.size) - 1)) and fits(rig, pose):
            poses.append(pose)
    return poses


def is_lit(rig: Rig, camera_from_board: Pose) -> bool:
    """Tell whether the laser's line crosses 8 cm of the squares and of the paper after them."""
    return len(underwater.cross(rig, camera_from_board, margin=BOARD.square)) >= 20


def photograph(
    rig: Rig, poses: Sequence[Pose], out: Path, *, seed: int, power: float = 1e-3
) -> Photographs:
    """Render the photos, unless they are there, and tell what is true of them."""
    paper = PAPER_BY_LASER if rig.lasers else PAPER
    radiance = paper / SENSOR.grey_per_electron / SENSOR.electrons_per_radiance(rig.wavelength)
    lamp = index_of(rig) ** 2  # radiance falls by as much where light leaves the water
    light = Light(power=power * lamp, ambient=math.pi * radiance / PRINT.white * lamp)
    truth = out / "truth"
    if not (truth / "mesh.ply").exists():
        times = np.arange(len(poses), dtype=float)
        way = Trajectory(times, *place_cameras(poses))
        simulate_recording(Scene(bodies(), rig, way, times, light=light, sensor=SENSOR, seed=seed),
                           out)  # fmt: skip
    stripes = load_true_stripe(truth / "stripes.parquet")
    truths, crlb = {}, {}
    for number, pose in enumerate(poses):
        name = f"{number:06d}.png"
        mine = np.flatnonzero((stripes.frame == number) & (np.abs(stripes.points[:, 2]) < 1e-6))
        mine = mine[np.argsort(stripes.pixels[mine, 1])]
        corners = project(rig.camera, pose @ BOARD.points(), index_of(rig))
        truths[name] = Sighting(name, corners, BOARD.points(), pose, stripes.pixels[mine])
        crlb[name] = stripes.crlb[mine]
    return Photographs(out / "frames", truths, crlb)


def bodies() -> tuple[Body, Body]:
    """Give the board, and a dark wall half a metre behind it."""
    wall = Pose(np.eye(3), np.array([0.12, 0.075, 0.5]))
    return (
        Body(Chessboard(BOARD.columns, BOARD.rows, BOARD.square).mesh(), Pose.identity(), PRINT),
        Body(Plane(4.0, 4.0).mesh(), wall, Plain(0.1)),
    )


def place_cameras(poses: Sequence[Pose]) -> tuple[np.ndarray, np.ndarray]:
    """Give positions and quaternions of the camera in the board's frame."""
    world_from_camera = [pose.inverse() for pose in poses]
    rotations = Rotation.from_matrix([pose.rotation for pose in world_from_camera])
    positions = np.array([pose.translation for pose in world_from_camera])
    return positions, rotations.as_quat(scalar_first=True)


def corner_errors(found: Sequence[Sighting], photos: Photographs) -> np.ndarray:
    """Give how far found corners are from the true ones, along u and v [px]."""
    return np.concatenate([s.corners - _truth(s, photos).corners for s in found])


def stripe_errors(found: Sequence[Sighting], photos: Photographs) -> tuple[np.ndarray, np.ndarray]:
    """Give how far found stripe points are from the true ones, and their bounds [px].

    Both are along the scan lines, which are rows.
    """
    errors, bounds = [], []
    for one, true in zip(found, as_true(found, photos), strict=True):
        errors.append(one.stripe[:, 0] - true.stripe[:, 0])
        rows = photos.truths[one.name].stripe[:, 1]
        bounds.append(np.interp(one.stripe[:, 1], rows, photos.crlb[one.name]))
    return np.concatenate(errors), np.concatenate(bounds)


def as_true(found: Sequence[Sighting], photos: Photographs) -> list[Sighting]:
    """Give what was found as it truly is: the same photos, corners and rows of the stripe."""
    return [replace(_truth(s, photos), stripe=_centres(s, photos)) for s in found]


def _truth(found: Sighting, photos: Photographs) -> Sighting:
    """Give what is true of those corners that were found."""
    true = photos.truths[found.name]
    column, row, _ = np.rint(found.points / BOARD.square).astype(int).T
    numbers = row * BOARD.columns + column
    return replace(true, corners=true.corners[numbers], points=true.points[numbers])


def _centres(found: Sighting, photos: Photographs) -> np.ndarray:
    if len(found.stripe) == 0:
        return found.stripe
    u, v = photos.truths[found.name].stripe.T
    rows = found.stripe[:, 1]
    return np.stack([np.interp(rows, v, u), rows], axis=1)
