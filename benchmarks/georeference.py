"""Lay a scan on simulated control points, and see whether the intervals hold the truth.

Run: python benchmarks/georeference.py [FOLDER]
"""

import json
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from harness import Figure, tell
from scipy.spatial.transform import Rotation

from murkscan.cli.main import run
from murkscan.geometry.control_fit import fit_control
from murkscan.io.cloud_files import load_cloud_file, writing_cloud_file
from murkscan.io.grid import find_grid
from murkscan.types.cloud import PointCloud
from murkscan.types.georeference import Georeference

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from tests.marked_wall import MarkedWall, scan_marked_wall

SEEDS, SIGMA = 40, 5e-3
CRS = "EPSG:25832+7837"
ORIGIN = np.array([432100.0, 5412345.0, -12.0])
NOTE = """
Six control points over 8 m × 3 m of a wall, each measured to 5 mm (1σ, along each axis), in each of
40 seeds with another turn, shift and errors. "within" counts the seeds whose easting of the wall's
middle lies within its stated 95 %; 34 to 40 of 40 are what chance allows. "ratio" is the root mean
square of the errors of five places over their stated deviations, along all axes. The round trip
carries points of the wall to the grid, through a file, and back.

*markers*: 48 ArUco markers of 90 mm on a wall that leans, filmed once along it from 0.6 m by a
camera of 360 × 288 px (a pixel is 2.2 mm there), a picture every 10 mm, by lamplight; scanned by
gray gravity with its true poses, and laid by `murkscan georeference` on a table that names the
markers. "within" counts the coordinates of their places on the model that lie within the stated
95 %; "ratio" is as above.
"""
CONTROL = np.array(
    [[0, 0, 0], [8, 0.2, 0.3], [7.5, 3, -0.4], [0.3, 2.8, 0.2], [4, 1.5, 0.8], [6, 2, -0.7]], float
)
PLACES = np.array(
    [[4, 1.5, 0.1], [0, 0, 0], [8, 3, 0], [12, 1.5, 0.5], [-2, 4.0, 0.2]], float
)  # fmt: skip


def lay(seed: int, scale: float) -> tuple[np.ndarray, np.ndarray]:
    """Give the errors of places in the grid, and their stated deviations [m]."""
    random = np.random.default_rng(seed)
    turn, shift = Rotation.random(rng=random).as_matrix(), random.normal(size=3)
    metre = np.array([scale, scale, 1.0])
    truth = ORIGIN + (PLACES @ turn.T + shift) * metre
    measured = ORIGIN + (CONTROL @ turn.T + shift) * metre
    measured += SIGMA * random.standard_normal(CONTROL.shape)
    fit = fit_control(CONTROL, (measured - ORIGIN) / metre, np.full(len(CONTROL), SIGMA))
    placed = Georeference(CRS, "", ORIGIN, scale, fit.target_from_model, fit.covariance)
    moves = [
        np.hstack([np.cross(np.eye(3), point).T, np.eye(3)])
        for point in fit.target_from_model @ PLACES
    ]
    sigma = [np.sqrt(np.diag(move @ fit.covariance @ move.T)) for move in moves]
    return placed.place(PLACES) - truth, np.array(sigma)


def round_trip(scale: float, wkt: str, suffix: str) -> float:
    """Give the largest way between a point and itself after the grid and a file [mm]."""
    random = np.random.default_rng(0)
    points = random.uniform([-20, 0, -1], [20, 8, 1], (100_000, 3))
    blank, none = np.zeros(len(points), np.float32), np.zeros(len(points), np.uint8)
    whole = np.zeros(len(points), np.int32)
    cloud = PointCloud(
        points, np.zeros((len(points), 3), np.float32), blank, blank, blank, blank, whole, whole,
        none, none,
    )  # fmt: skip
    turn, shift = Rotation.random(rng=random).as_matrix(), random.normal(size=3)
    fit = fit_control(CONTROL, CONTROL @ turn.T + shift, np.full(len(CONTROL), SIGMA))
    placed = Georeference(CRS, wkt, ORIGIN, scale, fit.target_from_model, fit.covariance)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"wall.{suffix}"
        with writing_cloud_file(path, wkt=wkt) as write:
            write(placed.carry(cloud))
        back = placed.place_back(load_cloud_file(path).points)
    return 1e3 * float(np.abs(back - points).max())


def judge_markers(folder: Path, scale: float) -> list[Figure]:
    """Lay a wall on its markers."""
    middles = [(x, y) for y in np.arange(12) * 0.15 - 0.82 for x in (-0.24, -0.08, 0.08, 0.24)]
    wall = scan_marked_wall(folder, middles, length=2.0)
    table = write_table(folder / "control.csv", wall, scale)
    assert run(["georeference", str(wall.out), "--control", str(table), "--crs", CRS]) == 0
    record = json.loads((wall.out / "georeference/stage.json").read_text("utf-8"))
    told = record["result"]["markers"]
    places = np.array([one["place_m"] for one in told])
    sigma = np.array([one["sigma_m"] for one in told])[:, None]
    off = places - wall.markers
    within = 100 * float(np.mean(np.abs(off) < 1.96 * sigma))
    ratio = float(np.sqrt(np.mean((off / sigma) ** 2)))
    largest = 1e3 * float(np.linalg.norm(off, axis=1).max())
    return [
        Figure("markers placed", len(told), "of 48", at_least=48),
        Figure("markers: largest error of a place", largest, "mm", at_most=1.0),
        Figure(
            "markers: error of a place, RMS",
            1e3 * float(np.sqrt((off**2).sum(axis=1).mean())),
            "mm",
        ),
        Figure("markers: stated deviation, median", 1e3 * float(np.median(sigma)), "mm"),
        Figure("markers: coordinates within 95 %", within, "%", at_least=90, at_most=99),
        Figure(
            "markers: errors over stated deviations, ratio", ratio, "", at_least=0.5, at_most=1.3
        ),
    ]


def write_table(path: Path, wall: MarkedWall, scale: float) -> Path:
    """Write a surveyor's table that names the markers."""
    turn = Rotation.from_euler("xyz", [95, 3, 40], degrees=True).as_matrix()
    places = ORIGIN + wall.markers @ turn.T * [scale, scale, 1.0]
    lines = ["name,easting_m,northing_m,height_m,sigma_mm,marker"]
    lines += [f"M{n},{','.join(map(repr, one))},1,{n}" for n, one in enumerate(places.tolist())]
    path.write_text("\n".join(lines) + "\n", "utf-8")
    return path


def main() -> None:
    kept = Path(sys.argv[1]) if len(sys.argv) > 1 else None
    start = time.perf_counter()
    grid = find_grid(CRS, ORIGIN)
    found = [lay(seed, grid.scale) for seed in range(SEEDS)]
    errors, sigma = (np.array(part) for part in zip(*found, strict=True))
    within = int((np.abs(errors[:, 0, 0]) < 1.96 * sigma[:, 0, 0]).sum())
    ratio = float(np.sqrt(np.mean((errors / sigma) ** 2)))
    share = 100 * float(np.mean(np.abs(errors) < 1.96 * sigma))
    figures = [
        Figure("seeds within 95 %", within, "of 40", at_least=34),
        Figure("all places and axes within 95 %", share, "%", at_least=92, at_most=98),
        Figure("errors over stated deviations, ratio", ratio, "", at_least=0.8, at_most=1.15),
        Figure("largest stated deviation of the middle", 1e3 * float(sigma[:, 0].max()), "mm"),
    ]
    figures += [
        Figure(f"round trip by {suffix}", round_trip(grid.scale, grid.wkt, suffix), "mm", 0.1)
        for suffix in ("laz", "e57", "ply", "csv", "xyz")
    ]
    with tempfile.TemporaryDirectory() as temporary:
        figures += judge_markers(kept or Path(temporary), grid.scale)
    figures.append(Figure("time", time.perf_counter() - start, "s"))
    tell("georeference", "Control points", figures, note=NOTE)


if __name__ == "__main__":
    main()
