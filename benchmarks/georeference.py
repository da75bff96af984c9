"""Lay a scan on simulated control points, and see whether the intervals hold the truth."""

import tempfile
import time
from pathlib import Path

import numpy as np
from harness import Figure, tell
from scipy.spatial.transform import Rotation

from murkscan.geometry.control_fit import fit_control
from murkscan.io.cloud_files import load_cloud_file, writing_cloud_file
from murkscan.io.grid import find_grid
from murkscan.types.cloud import PointCloud
from murkscan.types.georeference import Georeference

SEEDS, SIGMA = 40, 5e-3
CRS = "EPSG:25832+7837"
ORIGIN = np.array([432100.0, 5412345.0, -12.0])
NOTE = """
Six control points over 8 m × 3 m of a wall, each measured to 5 mm (1σ, along each axis), in each of
40 seeds with another turn, shift and errors. "within" counts the seeds whose easting of the wall's
middle lies within its stated 95 %; 34 to 40 of 40 are what chance allows. "ratio" is the root mean
square of the errors of five places over their stated deviations, along all axes. The round trip
carries points of the wall to the grid, through a file, and back.
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


def main() -> None:
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
    figures.append(Figure("time", time.perf_counter() - start, "s"))
    tell("georeference", "Control points", figures, note=NOTE)


if __name__ == "__main__":
    main()
