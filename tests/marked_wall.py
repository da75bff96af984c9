"""A wall with square markers on it, filmed once along it by lamplight."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import cv2
import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from murkscan.cli.main import run
from murkscan.optics.beam import Light
from murkscan.simulate import Body, Scene, Sensor
from murkscan.simulate.shapes import Plane
from murkscan.simulate.textures import AbstractTexture
from murkscan.survey.simulate import simulate_recording
from murkscan.types.camera import Camera
from murkscan.types.laser import Laser
from murkscan.types.pose import Pose
from murkscan.types.rig import Rig
from murkscan.types.trajectory import Trajectory

DICTIONARY = "4X4_50"
AWAY = 0.6
"""Distance of the wall's middle [m]."""


@dataclass(frozen=True)
class Marked(AbstractTexture):
    """Grey paint with white sheets, on each a marker; the first has number 0."""

    middles: tuple[tuple[float, float], ...]
    """Of the markers [m]."""
    side: float = 0.09
    """Of a marker's black frame [m]; the sheet is a third wider."""

    def albedo(self, points):
        away, number = cKDTree(self.middles).query(points[:, :2], p=np.inf)
        told = np.where(away < 2 / 3 * self.side, 0.8, 0.3)
        print_ = away < self.side / 2
        where = (points[print_, :2] - np.array(self.middles)[number[print_]]) / self.side + 0.5
        column, row = np.floor(6 * where).astype(int).T
        is_white = _pictures(len(self.middles))[number[print_], row, column]
        told[print_] = np.where(is_white, 0.8, 0.06)
        return told


@cache
def _pictures(count):
    """Give the modules of the first markers, white or not."""
    known = cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, f"DICT_{DICTIONARY}"))
    return np.array([cv2.aruco.generateImageMarker(known, n, 6) > 0 for n in range(count)])


@dataclass(frozen=True, eq=False)
class MarkedWall:
    """A scan of it, and where the markers truly are in its world."""

    out: Path
    markers: np.ndarray


def scan_marked_wall(
    folder: Path, middles, *, length: float, size=(360, 288), finder="murk"
) -> MarkedWall:
    """Film and scan a wall that leans, by its true poses, 10 mm from frame to frame."""
    width, height = size
    focal = 277.0 * width / 360
    camera = Camera(size, (focal, focal), ((width - 1) / 2, (height - 1) / 2))
    rig = Rig(camera, (Laser.from_baseline_angle(0.25, np.arctan2(AWAY, 0.25), "y"),), 532e-9)
    times = np.arange(round(length / 0.01)) / 10
    places = np.stack([0 * times, 0.1 * times - length / 2, 0 * times], axis=1)
    way = Trajectory(times, places, np.tile([1.0, 0.0, 0.0, 0.0], (len(times), 1)))
    leans = Pose(
        Rotation.from_euler("xy", [4, -6], degrees=True).as_matrix(), np.array([0.0, 0.0, AWAY])
    )
    wall = Body(Plane(2.0, length + 2.0).mesh(), leans, texture=Marked(tuple(middles)))
    sensor = Sensor(peak_grey=150.0, read_noise=2.0)
    light = Light(ambient=LAMP)
    if not (folder / "film").exists():
        scene = Scene((wall,), rig, way, times, sensor=sensor, light=light)
        simulate_recording(scene, folder / "film")
    words = ("--rig", str(folder / "film/rig.toml"), "--extractor", finder)
    poses, out = ("--poses", str(folder / "film/poses.csv")), folder / "out"
    assert run(["extract", str(folder / "film/frames"), *words, "--out", str(out)]) == 0
    assert run(["triangulate", str(out)]) == 0
    assert run(["motion", str(out), *poses]) == 0
    assert run(["cloud", str(out)]) == 0
    on_wall = np.concatenate([np.array(middles), np.zeros((len(middles), 1))], axis=1)
    return MarkedWall(out, leans @ on_wall)


LAMP = 1.0
"""Irradiance by lamps in the laser's colour [W/m²]: the sheets are some third as bright as the
line."""
