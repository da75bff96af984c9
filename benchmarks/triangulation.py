"""Triangulate a million skeleton pixels: whole arrays against the paper's loop over pixels."""

import math
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from harness import Figure, best_time, tell

from murkscan.triangulate import BaselineAngle, RaySheet
from murkscan.types.camera import Camera
from murkscan.types.laser import Laser
from murkscan.types.rig import Rig

COUNT = 1_000_000
CHUNK = 50_000

LASER = Laser.from_baseline_angle(0.2, math.radians(65), "y")
PLAIN = Rig(Camera((720, 576), (554.0, 554.0), (359.5, 287.5)), (LASER,))
BENT = Rig(
    Camera((720, 576), (554.0, 554.0), (359.5, 287.5), np.array([-0.2, 0.05, 1e-3, -1e-3, 0.0])),
    (LASER,),
)


def paper_loop(pixels: Iterable[tuple[float, float]], rig: Rig) -> list[tuple[float, float, float]]:
    """Run equation (4) pixel by pixel, as the paper describes it."""
    (fx, fy), (cx, cy) = rig.camera.focal_length, rig.camera.principal_point
    baseline, angle = rig.lasers[0].as_baseline_angle()
    cot = 1 / math.tan(angle)
    points = []
    for u, v in pixels:
        x, y = (u - cx) / fx, (v - cy) / fy
        depth = baseline / (cot - y)
        points.append((x * depth, y * depth, depth))
    return points


def main() -> None:
    rng = np.random.default_rng(0)
    pixels = np.floor(rng.random((COUNT, 2)) * [720, 500])
    listed = [(float(u), float(v)) for u, v in pixels]
    chunks = [pixels[i : i + CHUNK] for i in range(0, COUNT, CHUNK)]
    equation, ray = BaselineAngle(), RaySheet()
    for method in (equation, ray):
        method.locate(pixels[:10], BENT, 0)  # compiles

    def in_chunks(workers: int) -> None:
        with ThreadPoolExecutor(workers) as pool:
            list(pool.map(lambda chunk: ray.locate(chunk, BENT, 0), chunks))

    loop = best_time(lambda: paper_loop(pixels, PLAIN))
    prepared = best_time(lambda: paper_loop(listed, PLAIN))
    whole = best_time(lambda: equation.locate(pixels, PLAIN, 0))
    sheet = best_time(lambda: ray.locate(pixels, BENT, 0))
    one, two = best_time(lambda: in_chunks(1)), best_time(lambda: in_chunks(2))
    tell(
        "triangulation",
        "Triangulation of one million skeleton pixels",
        [
            Figure("loop / equation (4) on arrays, one core", loop / whole, ": 1", at_least=50),
            Figure("loop over prepared Python numbers / equation (4)", prepared / whole, ": 1"),
            Figure("loop / ray and sheet with distortion, one core", loop / sheet, ": 1"),
            Figure("one core / two cores, ray and sheet in chunks", one / two, ": 1"),
            Figure("loop", loop * 1e3, "ms"),
            Figure("equation (4) on arrays", whole * 1e3, "ms"),
            Figure("ray and sheet with distortion", sheet * 1e3, "ms"),
        ],
        note="The loop takes the pixels from an array, as a skeleton comes; the prepared one from "
        "a list of Python numbers, the fastest form that a loop can have. Each time is the "
        "shortest of seven runs in one process. The paper claims 10 : 1 from running in parallel "
        "on all of its cores.",
    )


if __name__ == "__main__":
    main()
