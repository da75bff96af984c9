"""Refraction: a real tank of water, shortest ways, what it costs, and what its neglect costs.

Run: python benchmarks/refraction.py [--data FOLDER]
"""

import argparse
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
from harness import DATA, Figure, tell
from scipy.io import loadmat
from scipy.optimize import least_squares, minimize
from scipy.spatial.transform import Rotation

from murkscan.capture import open_recording
from murkscan.extract import GrayGravity
from murkscan.optics import (
    back_project,
    equivalent_plane,
    intersect_rays_with_sheet,
    project,
    trace_fan,
)
from murkscan.triangulate import RaySheet, triangulate
from murkscan.types.camera import Camera
from murkscan.types.laser import Fan, Laser
from murkscan.types.port import DomePort, FlatPort, Layer, Port
from murkscan.types.pose import Pose
from murkscan.types.rig import Rig
from murkscan.types.stripe import Stripe
from murkscan.types.water import Water

WATER = 1.34
AHEAD = np.array([0.0, 0.0, 1.0])
TURNED = np.array([0.15, -0.1, 1.0]) / np.linalg.norm([0.15, -0.1, 1.0])
FLAT = FlatPort(AHEAD, 0.03, (Layer(0.008, 1.49),))
DOME = DomePort(np.array([0.004, -0.003, 0.007]), 0.05, 0.005, 1.49)
PORTS: dict[str, Port] = {
    "flat": FLAT,
    "tilted flat": FlatPort(TURNED, 0.03, (Layer(0.008, 1.49),)),
    "three layers": FlatPort(TURNED, 0.03, (Layer(0.008, 1.49), Layer(0.02, 1), Layer(0.01, 1.5))),
    "decentred dome": DOME,
}
HALF_ANGLE = np.radians(30)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, default=DATA)
    tank = parser.parse_args().data / "water_tank"
    figures = [
        *(measure_tank(tank) if tank.is_dir() else ()),
        *measure_fan(),
        *measure_inverse(),
        *measure_speed(),
        measure_scan(),
        *measure_neglect(),
    ]
    tell(
        "refraction",
        "Light through glass and water",
        figures,
        note="Speeds are of one core, the best of five runs, a million pixels all over a "
        "720 × 576 picture with lens distortion. The scan is read from PNG files, its stripes "
        "found by gray gravity and triangulated with their uncertainty, without what comes after. "
        "Depth errors: f 1400 px, 1920 columns, port 20 mm ahead, glass 10 mm, baseline 0.25 m, "
        "the sheet crossing the axis at 1 m, RMS along the line on a wall.",
    )


def camera_behind(port: Port | None) -> Camera:
    """Make the paper's camera, 66 degrees wide."""
    bent = np.array([-0.2, 0.05, 0.001, -0.0005, 0.0])
    return Camera((720, 576), (554.0, 554.8), (359.5, 287.5), bent, port)


def fan_behind(port: Port | None) -> Fan:
    """Make a fan at 14 degrees to the camera's axis that crosses it at a metre in air."""
    lean = np.radians(14)
    direction = np.array([0.0, np.sin(lean), np.cos(lean)])
    return Fan(np.array([0, -0.25, 0.0]), direction, np.array([1.0, 0, 0]), HALF_ANGLE, port)


def measure_tank(folder: Path) -> Iterator[Figure]:
    recorded = loadmat(folder / "RealData.mat")
    matrix, measured = recorded["KK"], Pose(recorded["Rgt"], recorded["Tgt"].ravel() / 1e3)
    corners = np.ascontiguousarray(recorded["Pall"].T / 1e3)
    pixels = np.ascontiguousarray(recorded["CameraRays"][:2].T)
    camera = Camera((4000, 3000), (matrix[0, 0], matrix[1, 1]), (matrix[0, 2], matrix[1, 2]))

    def miss(x: np.ndarray, used: np.ndarray) -> np.ndarray:
        view = camera
        if len(x) > 6:
            normal = np.array([x[6], x[7], 1.0])
            slab = FlatPort(normal / np.linalg.norm(normal), 0.2, (Layer(x[8], 1.33),))
            view = replace(camera, port=slab)
        board = camera_from_board(x) @ corners[used]
        return (project(view, board, 1.0) - pixels[used]).ravel()

    everything = np.ones(len(corners), dtype=bool)
    _, turn, shift = cv2.solvePnP(corners, pixels, matrix, np.zeros(5))
    start = np.concatenate([turn.ravel(), shift.ravel()])
    central = least_squares(miss, start, x_scale="jac", args=(everything,))
    yield Figure("water_tank, central camera: RMS", rms_of(central.fun), "px")
    x, used = np.concatenate([central.x, [0, 0, 0.15]]), everything
    for step in range(4):
        answer = least_squares(miss, x, x_scale="jac", args=(used,))
        if step == 0:
            yield Figure("water_tank, all 144 corners: RMS", rms_of(answer.fun), "px")
            yield Figure("water_tank, all 144 corners: water", 1e3 * answer.x[8], "mm")
        lengths = np.linalg.norm(miss(answer.x, everything).reshape(-1, 2), axis=1)
        # Four robust standard deviations; a Gaussian's median length in the plane is 1.1774.
        x, used = answer.x, lengths <= 4 * np.median(lengths) / 1.1774
    pose = camera_from_board(x)
    turned = Rotation.from_matrix(measured.rotation.T @ pose.rotation).magnitude()
    away = np.linalg.norm(measured.translation - pose.translation)
    yield Figure("water_tank: corners used of 144", len(answer.fun) / 2)
    yield Figure("water_tank: RMS", rms_of(answer.fun), "px", at_most=0.40)
    yield Figure("water_tank: water, off 256.8 mm by", abs(1e3 * x[8] - 256.8), "mm", at_most=1)
    yield Figure("water_tank: turn from measured pose", np.degrees(turned), "deg", at_most=0.1)
    yield Figure("water_tank: shift from measured pose", 1e3 * away, "mm", at_most=3)


def camera_from_board(x: np.ndarray) -> Pose:
    """Give the pose of the first six parameters."""
    return Pose(Rotation.from_rotvec(x[:3]).as_matrix(), np.asarray(x[3:6]))


def rms_of(residuals: np.ndarray) -> float:
    """Give the root mean square length of residuals u v u v ... [px]."""
    return float(np.sqrt(np.mean(np.sum(residuals.reshape(-1, 2) ** 2, axis=1))))


def measure_fan() -> Iterator[Figure]:
    fan, angles = fan_behind(FLAT), np.linspace(-HALF_ANGLE, HALF_ANGLE, 13)
    rays = trace_fan(fan, angles, WATER)
    inside = np.cos(angles)[:, None] * fan.direction + np.sin(angles)[:, None] * fan.tangent
    worst = 0.0
    for distance in (1.0, 2.0):
        for ray, target in zip(inside, rays.origins + distance * rays.directions, strict=True):
            first = shortest_way_into(target - fan.origin)
            worst = max(worst, float(np.linalg.norm(first - ray) * distance))
    yield Figure("fan, traced against shortest way", 1e6 * worst, "µm", at_most=1)
    fan = replace(fan, origin=np.array([0, -0.25, -0.038]))
    plane = equivalent_plane(Laser.from_sheet(fan), 1.333, near=0.3, far=2.0)
    rays = trace_fan(fan, np.linspace(-HALF_ANGLE, HALF_ANGLE, 601), 1.333)
    for depth, expected in ((1.0, 8.4), (2.0, 16.7)):
        reach = (depth - rays.origins[:, 2:]) / rays.directions[:, 2:]
        off = np.abs(plane.distance_to(rays.origins + reach * rays.directions)).max()
        name = f"fan, off its best plane at {depth:g} m (field: {expected:g})"
        yield Figure(name, 1e3 * float(off), "mm")


def shortest_way_into(target: np.ndarray) -> np.ndarray:
    """Direction of the first leg of the shortest optical way through the flat port, in its plane.

    The port's normal is the axis, so the way lies in the plane of axis and target: two offsets.
    """
    offset, depths = np.hypot(target[0], target[1]), np.array([0.0, 30.0, 38.0, 1e3 * target[2]])

    def optical_length(x: np.ndarray) -> float:
        across = np.array([0.0, x[0], x[1], 1e3 * offset])
        return float(np.hypot(np.diff(across), np.diff(depths)) @ [1.0, 1.49, WATER])

    x = np.zeros(2)
    for _ in range(2):
        x = minimize(optical_length, x, jac="3-point", options={"gtol": 1e-10}).x
    first = np.array([*(x[0] * target[:2] / offset), 30.0])
    return first / np.linalg.norm(first)


def measure_inverse() -> Iterator[Figure]:
    u, v = np.meshgrid(np.linspace(-0.5, 719.5, 145), np.linspace(-0.5, 575.5, 117))
    pixels = np.stack([u.ravel(), v.ravel()], axis=1)
    for name, port in PORTS.items():
        camera, worst = camera_behind(port), 0.0
        rays = back_project(camera, pixels, WATER)
        for distance in (0.2, 0.5, 1.0, 2.0, 5.0):
            again = project(camera, rays.origins + distance * rays.directions, WATER)
            worst = max(worst, float(np.abs(again - pixels).max()))
        yield Figure(f"projection of back projection, {name}", worst, "px", at_most=1e-6)


def measure_speed() -> Iterator[Figure]:
    pixels = np.random.default_rng(0).uniform((0, 0), (719, 575), (1_000_000, 2))
    for name, port, laser_port, bar in (
        ("no port, plane", None, None, None),
        ("flat port, fan in air", FLAT, None, 2.0),
        ("flat port, fan behind flat port", FLAT, FLAT, 2.0),
        ("dome, fan behind dome", DOME, DOME, None),
    ):
        camera, laser = camera_behind(port), Laser.from_sheet(fan_behind(laser_port))

        def locate(camera: Camera = camera, laser: Laser = laser) -> None:
            intersect_rays_with_sheet(back_project(camera, pixels, WATER), laser, WATER)

        yield Figure(f"{name}: points", 1 / best_time(locate), "M/s", at_least=bar)
    for name, port in PORTS.items():
        camera = camera_behind(port)
        rays = back_project(camera, pixels, WATER)
        points = rays.origins + rays.directions

        def see(camera: Camera = camera, points: np.ndarray = points) -> None:
            project(camera, points, WATER)

        yield Figure(f"projection, {name}: points", 1 / best_time(see), "M/s")


def best_time(work: Callable[[], None]) -> float:
    """Give the shortest of five times [s], after one run that may compile."""
    work()
    times = []
    for _ in range(5):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return min(times)


def measure_scan() -> Figure:
    columns, rows = np.arange(720.0), np.arange(576.0)[:, None]
    bare = Rig(camera_behind(None), (Laser.from_sheet(fan_behind(None)),))
    windows = Rig(camera_behind(FLAT), (Laser.from_sheet(fan_behind(FLAT)),), water=Water())
    with tempfile.TemporaryDirectory() as folder:
        for number in range(100):
            centre = 300 + 20 * np.sin(columns / 90 + number / 9)
            image = 8 + 200 * np.exp(-0.5 * ((rows - centre) / 2) ** 2)
            cv2.imwrite(f"{folder}/{number:04d}.png", image.astype(np.uint8))
        recording = open_recording(Path(folder))
        background = GrayGravity().learn(recording.sample(8), bare)

        def scan(rig: Rig) -> None:
            found = GrayGravity().extract(recording.frames(), rig, background)
            triangulate(Stripe.concatenate(list(found)), rig, RaySheet())

        ratio = best_time(lambda: scan(windows)) / best_time(lambda: scan(bare))
    return Figure("scan through ports / scan without", ratio, ": 1", at_most=1.5)


def measure_neglect() -> Iterator[Figure]:
    port, index = FlatPort(AHEAD, 0.02, (Layer(0.01, 1.49),)), 1.3415
    camera = Camera((1920, 1200), (1400.0, 1400.0), (959.5, 599.5), port=port)
    laser = Laser.from_baseline_angle(0.25, float(np.arctan2(1.0, 0.25)), "y")
    nearer = replace(port, distance=0.021)
    for name, wrong, wrong_index in (
        ("water ignored", replace(camera, port=None), None),
        ("index wrong by 0.0065", camera, index - 0.0065),
        ("index wrong by 0.001", camera, index - 0.001),
        ("port distance wrong by 1 mm", replace(camera, port=nearer), index),
    ):
        for depth in (0.4, 0.8, 1.5, 2.0):
            wall = np.full((1001, 3), depth)
            wall[:, 0] = np.linspace(-0.5, 0.5, 1001) * depth
            wall[:, 1] = -0.25 + depth * 0.25
            pixels = project(camera, wall, index)
            in_picture = (pixels[:, 0] > -0.5) & (pixels[:, 0] < 1919.5)
            rays = back_project(wrong, pixels[in_picture], wrong_index)
            error = intersect_rays_with_sheet(rays, laser)[:, 2] - depth
            value = 1e3 * float(np.sqrt(np.mean(error**2)))
            yield Figure(f"depth error at {depth:g} m, {name}", value, "mm")


if __name__ == "__main__":
    main()
