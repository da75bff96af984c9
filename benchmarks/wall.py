"""Draw the elevation of a simulated wall of sheet piles with a bulge, and judge its curves."""

import csv
import json
import sys
import tempfile
from pathlib import Path

import numpy as np
from harness import Figure, tell

from murkscan.cli.main import run
from murkscan.simulate import Body, Scene, Sensor
from murkscan.simulate.shapes import SheetPile
from murkscan.simulate.textures import Plain
from murkscan.survey.simulate import simulate_recording
from murkscan.types.camera import Camera
from murkscan.types.laser import Laser
from murkscan.types.pose import Pose
from murkscan.types.rig import Rig
from murkscan.types.trajectory import Trajectory

WALL = SheetPile(width=1.2, height=9.0, bulge=0.03, bulge_width=1.0)
AWAY, FRAMES, STEP, STRIP = 0.6, 420, 0.02, 0.06
"""Distance of the outer faces, frames, way between them, width of a curve's strip; lengths [m]."""
BESIDE = 0.075
"""x of the camera beside the middle of the wall [m]: it looks at the middle of an outer face."""
NOTE = """
A wall of sheet piles (ribs of 0.6 m, 150 mm deep) that bulges by 30 mm, a Gaussian of 1 m, is
filmed from 0.6 m on one way of 8.4 m down it, by a camera of 360 × 288 px, a stripe every 20 mm. It
is scanned with its true poses by the default finder, and `murkscan measure wall` draws it against
the plane of the outer faces. Places are pieces of 20 mm of the curves whose strip of 60 mm lies
within an outer or an inner face; each is of another frame, at a place of its own. The truth is the
shape's own formula.
"""


def simulate(folder: Path) -> None:
    """Film the wall in clear air."""
    camera = Camera(size=(360, 288), focal_length=(277.0, 277.0), principal_point=(179.5, 143.5))
    rig = Rig(camera, (Laser.from_baseline_angle(0.25, np.arctan2(0.6, 0.25), "y"),), 532e-9)
    times = np.arange(FRAMES) / 10
    start = -FRAMES * STEP / 2
    positions = np.stack([0 * times + BESIDE, start + STEP * 10 * times, 0 * times], axis=1)
    way = Trajectory(times, positions, np.tile([1.0, 0.0, 0.0, 0.0], (FRAMES, 1)))
    body = Body(WALL.mesh(), Pose(np.eye(3), np.array([0.0, 0.0, AWAY])), texture=Plain(0.2))
    sensor = Sensor(peak_grey=180.0, read_noise=2.0)
    simulate_recording(Scene((body,), rig, way, times, sensor=sensor), folder)


def true_distance(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Give the mean of a strip's distance out of the plane of the outer faces [m]."""
    across = x[:, None] + np.linspace(-STRIP / 2, STRIP / 2, 25)
    return -WALL.depth_at(across, np.broadcast_to(y[:, None], across.shape)).mean(axis=1)


def is_in_face(x: np.ndarray) -> np.ndarray:
    """Tell whether a strip lies within an outer or an inner face, 5 mm clear of their edges."""
    part = np.mod(x / WALL.rib, 0.5) * WALL.rib
    return (part > STRIP / 2 + 0.005) & (part < WALL.rib / 4 - STRIP / 2 - 0.005)


def main() -> None:
    kept = Path(sys.argv[1]) if len(sys.argv) > 1 else None
    with tempfile.TemporaryDirectory() as temporary:
        folder = kept or Path(temporary)
        film, out = folder / "film", folder / "out"
        if not film.exists():
            simulate(film)
        rig = ("--rig", str(film / "rig.toml"), "--poses", str(film / "poses.csv"))
        assert run(["scan", str(film / "frames"), *rig, "--out", str(out)]) == 0
        plane = (f"--point-m=0,0,{AWAY}", "--normal=0,0,-1")
        drawn = ("--sections", "12", "--strip-mm", str(1e3 * STRIP), "--ribbed")
        assert run(["measure", str(out), "wall", *plane, *drawn, "--least-mm", "5"]) == 0
        with (out / "measure" / "wall-curves.csv").open() as file:
            rows = [{k: float(v or "nan") for k, v in row.items()} for row in csv.DictReader(file)]
        told = json.loads((out / "measure" / "wall.json").read_text("utf-8"))["details"]
    columns = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    chosen = is_in_face(columns["x_m"])
    columns = {name: column[chosen] for name, column in columns.items()}
    truth = 1e3 * true_distance(columns["x_m"], columns["y_m"])
    off = columns["distance_mm"] - truth
    half = (columns["high_95_mm"] - columns["low_95_mm"]) / 2
    largest = told["anomalies"][0] if told["anomalies"] else {}
    figures = [
        Figure("places of curves", len(off), "", at_least=400),
        Figure("largest error of a place", float(np.abs(off).max()), "mm", at_most=1.0),
        Figure("error of a place, RMS", float(np.sqrt(np.mean(off**2))), "mm"),
        Figure("mean error", float(off.mean()), "mm"),
        Figure("half the interval, median", float(np.median(half)), "mm"),
        Figure(
            "places inside of their interval",
            100 * float(np.mean(np.abs(off) < half)),
            "%",
            at_least=93,
            at_most=97,
        ),
        Figure("anomalies listed", len(told["anomalies"]), ""),
        Figure("largest one, distance", largest.get("distance_mm", float("nan")), "mm"),
        Figure("largest one, height", largest.get("rise_mm", float("nan")), "mm"),
    ]
    tell("wall", "The elevation of a wall", figures, note=NOTE)


if __name__ == "__main__":
    main()
