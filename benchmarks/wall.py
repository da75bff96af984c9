"""Draw simulated walls with a bulge in elevation, sheet piles and a cylinder; judge the curves."""

import csv
import json
import sys
import tempfile
from dataclasses import replace
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
from murkscan.types.mesh import Mesh
from murkscan.types.pose import Pose
from murkscan.types.rig import Rig
from murkscan.types.trajectory import Trajectory
from murkscan.types.wall import WallFrame

PILES = SheetPile(width=1.2, height=9.0, bulge=0.03, bulge_width=1.0)
AWAY, FRAMES, STEP, STRIP = 0.6, 420, 0.02, 0.06
"""Distance of the wall, frames, way between them, width of a curve's strip; lengths [m]."""
ACROSS = np.linspace(-STRIP / 2, STRIP / 2, 25)
"""Places of a strip, of which its mean is taken [m]."""
BESIDE = 0.075
"""x of the camera beside the middle of the sheet piles [m]: it looks at the middle of an outer
face."""
RADIUS = 1.5
"""Of the cylinder [m]."""
NOTE = """
*sheet piles*: ribs of 0.6 m, 150 mm deep, that bulge by 30 mm, a Gaussian of 1 m; distances are
taken from the plane of the outer faces. Places are pieces of 20 mm of the curves whose strip of
60 mm lies within an outer or an inner face.

*cylinder*: a pile of 1.5 m radius that bulges by 30 mm, a Gaussian of 0.6 m along and up it, seen
from outside; distances are taken from the cylinder as built (`--point-m --axis --radius-mm`), and
from the one that is fitted to the scan, whose radius the bulge changes. The truth of a curve is
the shape's distance from whichever cylinder the record names.

Each is filmed from 0.6 m on one way of 8.4 m down it, by a camera of 360 × 288 px, a stripe every
20 mm, scanned with its true poses by the default finder, and drawn by `murkscan measure wall`, in
12 curves. Each place is of another frame, at a place of its own. The truth is the shape's own
formula.
"""


class Pile:
    """A cylinder along y that bulges; its nearest line lies in z = 0, the camera's side is -z."""

    bulge, spread, length = 0.03, 0.6, 9.0

    def reach_at(self, along, y):
        """Give the distance from the axis [m], at a way round the pile as built."""
        return RADIUS + self.bulge * np.exp(-(along**2 + y**2) / (2 * self.spread**2))

    def distance_of(self, points):
        """Give about how far points lie outside of the surface [m]; 0 on it."""
        x, y, depth = points[:, 0], points[:, 1], RADIUS - points[:, 2]
        return np.hypot(x, depth) - self.reach_at(RADIUS * np.arctan2(x, depth), y)

    def mesh(self) -> Mesh:
        """Make the side that the camera sees, in cells of 2.5 mm round it and 10 mm along it.

        Between their corners it lies 1 µm too deep where the bulge bends most.
        """
        along = np.linspace(-0.6, 0.6, 481)
        y = np.linspace(-self.length / 2, self.length / 2, 901)
        along, y = np.meshgrid(along, y)
        reach, angle = self.reach_at(along, y), along / RADIUS
        vertices = np.stack([reach * np.sin(angle), y, RADIUS - reach * np.cos(angle)], axis=-1)
        number = np.arange(y.size).reshape(y.shape)
        a, b, c, d = (
            part.ravel()
            for part in (number[:-1, :-1], number[:-1, 1:], number[1:, :-1], number[1:, 1:])
        )
        faces = np.concatenate([np.stack([a, c, d], axis=1), np.stack([a, d, b], axis=1)])
        return Mesh(vertices.reshape(-1, 3), faces)


def film(folder: Path, mesh: Mesh, beside: float) -> None:
    """Film a wall in clear air."""
    camera = Camera(size=(360, 288), focal_length=(277.0, 277.0), principal_point=(179.5, 143.5))
    rig = Rig(camera, (Laser.from_baseline_angle(0.25, np.arctan2(0.6, 0.25), "y"),), 532e-9)
    times = np.arange(FRAMES) / 10
    start = -FRAMES * STEP / 2
    positions = np.stack([0 * times + beside, start + STEP * 10 * times, 0 * times], axis=1)
    way = Trajectory(times, positions, np.tile([1.0, 0.0, 0.0, 0.0], (FRAMES, 1)))
    body = Body(mesh, Pose(np.eye(3), np.array([0.0, 0.0, AWAY])), texture=Plain(0.2))
    sensor = Sensor(peak_grey=180.0, read_noise=2.0)
    simulate_recording(Scene((body,), rig, way, times, sensor=sensor), folder)


def scan(folder: Path, mesh: Mesh, beside: float = 0.0) -> Path:
    """Film a wall unless it has been, and scan it."""
    recording, out = folder / "film", folder / "out"
    if not recording.exists():
        film(recording, mesh, beside)
    rig = ("--rig", str(recording / "rig.toml"), "--poses", str(recording / "poses.csv"))
    assert run(["scan", str(recording / "frames"), *rig, "--out", str(out)]) == 0
    return out


def draw(out: Path, *words: str) -> tuple[dict[str, np.ndarray], dict]:
    """Draw a wall: the columns of its curves, and the record."""
    drawn = ("--sections", "12", "--strip-mm", str(1e3 * STRIP), "--least-mm", "5")
    assert run(["measure", str(out), "wall", *words, *drawn]) == 0
    with (out / "measure" / "wall-curves.csv").open() as file:
        rows = [{k: float(v or "nan") for k, v in row.items()} for row in csv.DictReader(file)]
    told = json.loads((out / "measure" / "wall.json").read_text("utf-8"))["details"]
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}, told


def piles_distance(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Give the mean of a strip's distance out of the plane of the outer faces [m]."""
    across = x[:, None] + ACROSS
    return -PILES.depth_at(across, np.broadcast_to(y[:, None], across.shape)).mean(axis=1)


def pile_distance(told: dict, along: np.ndarray, height: np.ndarray) -> np.ndarray:
    """Give the mean of a strip's distance out of the cylinder that a record names [m]."""
    axes = np.array([told["along"], told["up"], told["out"]])
    frame = WallFrame(np.array(told["origin_m"]), axes, told["radius_m"])
    located = np.stack(
        [
            (along[:, None] + ACROSS).ravel(),
            np.repeat(height, len(ACROSS)),
            0 * ACROSS.repeat(len(along)),
        ],
        axis=1,
    )
    for _ in range(20):  # the surface leans by a hundredth: each step leaves that of the last
        located[:, 2] -= Pile().distance_of(frame.place(located) - [0.0, 0.0, AWAY])
    return located[:, 2].reshape(len(along), -1).mean(axis=1)


def is_in_face(x: np.ndarray) -> np.ndarray:
    """Tell whether a strip lies within an outer or an inner face, 5 mm clear of their edges."""
    part = np.mod(x / PILES.rib, 0.5) * PILES.rib
    return (part > STRIP / 2 + 0.005) & (part < PILES.rib / 4 - STRIP / 2 - 0.005)


def judge(what: str, curves: dict[str, np.ndarray], truth: np.ndarray) -> list[Figure]:
    """Hold curves [mm] against the truth [m]."""
    off = curves["distance_mm"] - 1e3 * truth
    half = (curves["high_95_mm"] - curves["low_95_mm"]) / 2
    within = 100 * float(np.mean(np.abs(off) < half))
    figures = [
        Figure("places of curves", len(off), "", at_least=400),
        Figure("largest error of a place", float(np.abs(off).max()), "mm", at_most=1.0),
        Figure("error of a place, RMS", float(np.sqrt(np.mean(off**2))), "mm"),
        Figure("mean error", float(off.mean()), "mm"),
        Figure("half the interval, median", float(np.median(half)), "mm"),
        Figure("places inside of their interval", within, "%", at_least=93, at_most=97),
    ]
    return [replace(one, name=f"{what}: {one.name}") for one in figures]


def judge_piles(folder: Path) -> list[Figure]:
    out = scan(folder, PILES.mesh(), BESIDE)
    curves, told = draw(out, f"--point-m=0,0,{AWAY}", "--normal=0,0,-1", "--ribbed")
    chosen = is_in_face(curves["x_m"])
    curves = {name: column[chosen] for name, column in curves.items()}
    largest = told["anomalies"][0] if told["anomalies"] else {}
    return [
        *judge("sheet piles", curves, piles_distance(curves["x_m"], curves["y_m"])),
        Figure("sheet piles: anomalies listed", len(told["anomalies"]), ""),
        Figure("sheet piles: largest, distance", largest.get("distance_mm", np.nan), "mm"),
        Figure("sheet piles: largest, height", largest.get("rise_mm", np.nan), "mm"),
    ]


def judge_cylinder(folder: Path) -> list[Figure]:
    out = scan(folder, Pile().mesh())
    built = (f"--point-m=0,0,{AWAY + RADIUS}", "--axis=0,1,0", f"--radius-mm={1e3 * RADIUS}")
    figures = []
    for what, words in (("as built", built), ("fitted", ())):
        curves, told = draw(out, "--shape", "cylinder", *words)
        truth = pile_distance(told, curves["along_m"], curves["height_m"])
        figures += judge(f"cylinder, {what}", curves, truth)
        highest = float(curves["distance_mm"].max())
        figures.append(Figure(f"cylinder, {what}: farthest out", highest, "mm"))
    figures.append(Figure("cylinder, fitted: radius", 1e3 * told["radius_m"], "mm"))
    return figures


def main() -> None:
    kept = Path(sys.argv[1]) if len(sys.argv) > 1 else None
    with tempfile.TemporaryDirectory() as temporary:
        folder = kept or Path(temporary)
        figures = judge_piles(folder / "piles") + judge_cylinder(folder / "cylinder")
    tell("wall", "The elevation of a wall", figures, note=NOTE)


if __name__ == "__main__":
    main()
