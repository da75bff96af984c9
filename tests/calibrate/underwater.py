"""A rig under water that photographs boards and its laser's line on them, without pictures."""

import numpy as np

from murkscan.calibrate.adjust.observations import Sighting, index_of
from murkscan.geometry import intersect_rays_with_plane
from murkscan.optics import project, trace_fan
from murkscan.types.camera import Camera
from murkscan.types.laser import Fan, Laser
from murkscan.types.plane import Plane
from murkscan.types.port import DomePort, FlatPort, Layer
from murkscan.types.pose import Pose
from murkscan.types.rig import Rig
from murkscan.types.water import Water

from .boards import BOARD, rotation

GLASS = (Layer(0.008, 1.49),)
TILT = np.radians(2)
FLAT = FlatPort(np.array([np.sin(TILT), 0.0, np.cos(TILT)]), 0.03, GLASS)
DOME = DomePort(np.array([0.001, -0.002, 0.002]), 0.05, 0.006, 1.49)
"""Its centre is 3 mm away from the lens."""
LENS = Camera((1920, 1200), (1400.0, 1400.0), (959.5, 599.5), np.array([-0.1, 0.03, 0.0, 0.0, 0.0]))
AHEAD = np.array([0.25, 0.0, 1.0]) / np.hypot(0.25, 1.0)
POOL = Water(20.0, 0.0)
SHEET = Plane.through(np.array([-0.25, 0.0, 0.0]), np.cross(AHEAD, [0.0, 1.0, 0.0]))
FAN = Fan(
    np.array([-0.25, 0.0, 0.0]), AHEAD, np.array([0.0, 1.0, 0.0]), np.radians(25),
    FlatPort(np.array([0.0, 0.0, 1.0]), 0.03, GLASS),
)  # fmt: skip


def rig_behind(port, sheet=SHEET, water=POOL):
    """Put the lens behind a port, with a laser beside it."""
    camera = Camera(LENS.size, LENS.focal_length, LENS.principal_point, LENS.distortion, port)
    return Rig(camera, (Laser.from_sheet(sheet),), water=water if port is not None else None)


def hold_board(random, rig, near=0.4, far=1.6, most=30.0):
    """Give a pose of the board at which the rig sees all of it."""
    flat, size = BOARD.points(), np.array(rig.camera.size)
    while True:
        turned = rotation(*random.uniform(-most, most, 2), random.uniform(-25, 25))
        depth = np.exp(random.uniform(np.log(near), np.log(far)))
        aside = random.uniform(-0.45, 0.45, 2) * depth * size / rig.camera.focal_length
        pose = Pose(turned, np.array([*aside, depth]) - turned @ flat.mean(axis=0))
        seen = project(rig.camera, pose @ flat, index_of(rig))
        if np.all((seen > 5) & (seen < size - 6)):
            return pose


def see_boards(random, rig, count, noise=0.1, **how):
    """Photograph boards: corners with noise [px]."""
    poses = [hold_board(random, rig, **how) for _ in range(count)]
    return [see_board(random, rig, pose, f"board{i}", noise) for i, pose in enumerate(poses)]


def see_board(random, rig, pose, name, noise):
    corners = project(rig.camera, pose @ BOARD.points(), index_of(rig))
    corners = corners + random.normal(0, noise, corners.shape)
    return Sighting(name, corners, BOARD.points(), pose)


def see_stripes(random, rig, count, noise=0.1, near=0.45, far=2.0):
    """Photograph the laser's line on boards."""
    seen = []
    while len(seen) < count:
        pose = hold_board(random, rig, near, far)
        stripe = cross(rig, pose)
        if len(stripe) >= 20:
            board = see_board(random, rig, pose, f"line{len(seen)}", noise)
            stripe = stripe + random.normal(0, noise, stripe.shape)
            seen.append(Sighting(board.name, board.corners, board.points, pose, stripe))
    return seen


def cross(rig, camera_from_board, margin=0.06):
    """Give the pixels at which the line crosses the board's sheet of paper."""
    points = light(
        rig, Plane.through(camera_from_board.translation, camera_from_board.rotation[:, 2])
    )
    x, y, _ = (camera_from_board.inverse() @ points).T
    width, height = BOARD.columns * BOARD.square, BOARD.rows * BOARD.square
    on_paper = (x > -margin) & (x < width + margin) & (y > -margin) & (y < height + margin)
    pixels = project(rig.camera, points, index_of(rig))
    in_view = np.all((pixels > 0) & (pixels < np.array(rig.camera.size) - 1), axis=1)
    return pixels[on_paper & in_view]


def light(rig, plane, count=240):
    """Give points of the laser's line on a plane."""
    sheet = rig.lasers[0].sheet
    if isinstance(sheet, Fan):
        angles = np.linspace(-sheet.half_angle, sheet.half_angle, count)
        return intersect_rays_with_plane(trace_fan(sheet, angles, index_of(rig)), plane)
    along = np.cross(sheet.normal, plane.normal)
    along /= np.linalg.norm(along)
    middle = -plane.distance * plane.normal
    start = np.linalg.solve(
        np.stack([sheet.normal, plane.normal, along]),
        [-sheet.distance, -plane.distance, along @ middle],
    )
    return start + np.linspace(-1.0, 1.0, 2 * count)[:, None] * along
