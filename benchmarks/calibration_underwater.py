"""Calibrate simulated rigs under water, and triangulate true points with them, beside the bars.

Boards and stripes are projected, not rendered: corners and stripe centres with Gaussian noise.

Run: python benchmarks/calibration_underwater.py [--draws N]
"""

import argparse
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from harness import Figure, tell
from scipy.spatial.transform import Rotation

from murkscan.calibrate import (
    BoardView,
    Calibration,
    StripeOnBoard,
    calibrate_camera,
    calibrate_lasers,
    calibrate_port,
)
from murkscan.calibrate.adjust.observations import Sighting, index_of
from murkscan.calibrate.adjust.parameters import (
    INTRINSICS,
    port_parameters,
    sheet_parameters,
    window_prior,
)
from murkscan.calibrate.adjust.solve import adjust
from murkscan.calibrate.port import join
from murkscan.calibrate.region import spread_of_points
from murkscan.optics import back_project, intersect_rays_with_sheet, project
from murkscan.types.arrays import Pixels, Points
from murkscan.types.laser import Fan
from murkscan.types.plane import Plane
from murkscan.types.port import FlatPort, Port
from murkscan.types.rig import Rig
from murkscan.types.rig_covariance import RigCovariance
from murkscan.types.water import Water

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from tests.calibrate import underwater
from tests.calibrate.boards import BOARD

COUNT = 25
"""Photos of each kind: boards in air, boards through the port, stripes."""
SEA = Water(20.0, 35.0)
INDEX = RigCovariance(("water.index",), np.array([[2e-4**2]]))


@dataclass(frozen=True)
class Outcome:
    """Error over range of one calibration: as measured, as it states itself, and others."""

    error: float
    stated: float
    in_the_sea: float
    aligned: float
    pinhole: float
    pinhole_in_the_sea: float


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--draws", type=int, default=12)
    draws = parser.parse_args().draws
    figures = [
        *measure("flat port tilted 2°", underwater.FLAT, underwater.SHEET, draws, (0.05, 0.06)),
        *measure("flat port, refracted fan", underwater.FLAT, underwater.FAN, draws, (0.05, 0.06)),
        *measure("dome 3 mm off", underwater.DOME, underwater.SHEET, draws, (0.05, 0.06)),
        *measure(
            "PAL, flat port", underwater.FLAT, underwater.SHEET, draws, (0.15, None), pal=True
        ),
        time_of_adjustment(),
    ]
    tell(
        "calibration_underwater",
        "Calibration of simulated rigs under water",
        figures,
        note=(
            f"{draws} calibrations each, of {COUNT} boards in air, {COUNT} through the port in "
            f"fresh water and {COUNT} stripes on boards at 0.45 to 2 m, all projected and not "
            "rendered, with Gaussian noise of 0.08 px on corners and stripe centres. Errors are "
            "those of true sheet points from 0.5 to 2 m, over their range, in the RMS over points "
            "and draws. The bound is the Cramér-Rao bound of the same photos at the true rig. "
            "The pinhole is a camera and a plane fitted in the fresh water to the same photos, "
            "judged after the best rigid motion, since its centre is another place."
        ),
    )


def measure(
    words: str,
    port: Port,
    sheet: Plane | Fan,
    draws: int,
    bars: tuple[float, float | None],
    *,
    pal: bool = False,
) -> Iterator[Figure]:
    rig = underwater.rig_behind(port, sheet)
    if pal:
        rig = replace(rig, camera=replace(rig.camera, size=(720, 576), focal_length=(600.0, 600.0),
                                          principal_point=(359.5, 287.5)))  # fmt: skip
    outcomes = [calibrate(rig, np.random.default_rng(seed)) for seed in range(draws)]
    names = ("error", "stated", "in_the_sea", "aligned", "pinhole", "pinhole_in_the_sea")
    rms = {n: float(np.sqrt(np.mean([getattr(o, n) ** 2 for o in outcomes]))) for n in names}
    yield Figure(f"{words}: error over range", 100 * rms["error"], "%", at_most=bars[0])
    yield Figure(f"{words}: as the calibration states", 100 * rms["stated"], "%")
    yield Figure(f"{words}: Cramér-Rao bound", 100 * bound(rig), "%")
    yield Figure(f"{words}: taken to 35 PSU", 100 * rms["in_the_sea"], "%", at_most=bars[1])
    yield Figure(f"{words}: after the best rigid motion", 100 * rms["aligned"], "%")
    yield Figure(f"{words}: pinhole in the same water", 100 * rms["pinhole"], "%")
    yield Figure(f"{words}: pinhole taken to 35 PSU", 100 * rms["pinhole_in_the_sea"], "%")


def calibrate(rig: Rig, random: np.random.Generator) -> Outcome:
    """Calibrate as the commands do: camera, port, laser; and once as if there were no water."""
    boards, wet, stripes = photograph(rig, random)
    camera = calibrate_camera(as_views(boards), BOARD, rig.camera.size).rig
    assert rig.camera.port is not None
    guess = replace(camera.camera, port=guess_of(rig.camera.port))
    start = replace(rig, camera=guess, covariance=camera.covariance)
    behind = calibrate_port(as_views(wet), BOARD, start).rig
    found = find_laser(behind, stripes)
    pinhole = calibrate_camera(as_views(wet), BOARD, rig.camera.size).rig
    simple = calibrate_lasers(*as_photos(stripes, pinhole), BOARD, pinhole)
    pixels, points = sheet_points(rig)
    sea = replace(rig, water=SEA)
    sea_pixels, sea_points = sheet_points(sea)
    at_sea = replace(found.rig, water=SEA)
    return Outcome(
        error=off(found.rig, pixels, points),
        stated=relative(spread_of_points(found.rig, 0, pixels), points),
        in_the_sea=off(at_sea, sea_pixels, sea_points),
        aligned=off_by_shape(found.rig, pixels, points),
        pinhole=off_by_shape(simple.rig, pixels, points),
        pinhole_in_the_sea=off_by_shape(simple.rig, sea_pixels, sea_points),
    )


def photograph(
    rig: Rig, random: np.random.Generator
) -> tuple[list[Sighting], list[Sighting], list[Sighting]]:
    air = replace(rig, camera=replace(rig.camera, port=None), water=None, lasers=())
    return (
        underwater.see_boards(random, air, COUNT, noise=0.08),
        underwater.see_boards(random, rig, COUNT, noise=0.08),
        underwater.see_stripes(random, rig, COUNT, noise=0.08),
    )


def find_laser(rig: Rig, stripes: Sequence[Sighting]) -> Calibration:
    sheet = rig.lasers[0].sheet
    if not isinstance(sheet, Fan):
        return calibrate_lasers(*as_photos(stripes, rig), BOARD, rig)
    rough = replace(sheet, origin=sheet.origin + 2e-3)
    return calibrate_lasers(*as_photos(stripes, rig), BOARD, rig, fans={0: rough})


def bound(rig: Rig) -> float:
    """Give the Cramér-Rao bound: the covariance of all photos at the true rig, without draws."""
    boards, wet, stripes = photograph(rig, np.random.default_rng(0))
    air = replace(rig, camera=replace(rig.camera, port=None), water=None, lasers=())
    assert rig.camera.port is not None
    ports, sheet = port_parameters(rig.camera.port), sheet_parameters(rig.lasers[0], 0)
    first = adjust(air, boards, INTRINSICS).rig.covariance
    second = adjust(rig, wet, (*INTRINSICS, *ports), prior=first).rig.covariance
    window = window_prior(rig.lasers[0], 0)
    names = (*INTRINSICS, *ports, *sheet, *window.names)
    third = adjust(rig, stripes, names, prior=join(second, window))
    pixels, points = sheet_points(rig)
    at_truth = replace(rig, covariance=third.rig.covariance)
    return relative(spread_of_points(at_truth, 0, pixels), points)


def sheet_points(rig: Rig) -> tuple[Pixels, Points]:
    """Give true points of the sheet from 0.5 to 2 m, where the stripe is in view."""
    planes = [Plane(np.array([0.0, 0.0, 1.0]), -z) for z in np.linspace(0.5, 2.0, 16)]
    points = np.concatenate([underwater.light(rig, plane) for plane in planes])
    pixels = project(rig.camera, points, index_of(rig))
    seen = np.all((pixels >= 0) & (pixels <= np.array(rig.camera.size) - 1), axis=1)
    return pixels[seen], points[seen]


def off(rig: Rig, pixels: Pixels, points: Points) -> float:
    return relative(np.linalg.norm(triangulate(rig, pixels) - points, axis=1), points)


def off_by_shape(rig: Rig, pixels: Pixels, points: Points) -> float:
    """Give what is left after the best rigid motion: a pinhole's centre is another place."""
    found = triangulate(rig, pixels)
    good = np.isfinite(found).all(axis=1)
    found, points = found[good], points[good]
    weights = 1 / np.linalg.norm(points, axis=1)
    middle, true_middle = (np.average(p, axis=0, weights=weights) for p in (found, points))
    turn, _ = Rotation.align_vectors(points - true_middle, found - middle, weights)
    moved = turn.apply(found - middle) + true_middle
    return relative(np.linalg.norm(moved - points, axis=1), points)


def triangulate(rig: Rig, pixels: Pixels) -> Points:
    rays = back_project(rig.camera, pixels, index_of(rig))
    return intersect_rays_with_sheet(rays, rig.lasers[0], index_of(rig))


def relative(errors: np.ndarray, points: Points) -> float:
    return float(np.sqrt(np.nanmean((errors / np.linalg.norm(points, axis=1)) ** 2)))


def guess_of(port: Port) -> Port:
    """Give the port as one would measure it with a ruler."""
    if isinstance(port, FlatPort):
        return replace(port, normal=np.array([0.0, 0.0, 1.0]), distance=port.distance + 1e-3)
    return replace(port, centre=np.zeros(3))


def as_views(sightings: Sequence[Sighting]) -> list[BoardView]:
    """Number the corners again, of which some may be missing."""
    views = []
    for sighting in sightings:
        column, row, _ = np.rint(sighting.points / BOARD.square).astype(int).T
        numbers = row * BOARD.columns + column
        views.append(BoardView(sighting.name, sighting.corners, numbers=numbers))
    return views


def as_photos(
    sightings: Sequence[Sighting], rig: Rig
) -> tuple[list[StripeOnBoard], list[BoardView]]:
    from murkscan.calibrate import locate_seen_board

    stripes = [
        StripeOnBoard(
            s.name, s.stripe, locate_seen_board(s.corners, s.points, rig.camera, index_of(rig))
        )
        for s in sightings
    ]
    return stripes, as_views(sightings)


def time_of_adjustment() -> Figure:
    """Time one adjustment of everything: 30 boards and 60 stripes, port, index and fan."""
    rig, random = underwater.rig_behind(underwater.FLAT, underwater.FAN), np.random.default_rng(1)
    seen = [
        *underwater.see_boards(random, rig, 30, noise=0.08),
        *underwater.see_stripes(random, rig, 60, noise=0.08),
    ]
    names = (*INTRINSICS, *port_parameters(underwater.FLAT), *sheet_parameters(rig.lasers[0], 0))
    adjust(rig, seen[:4] + seen[-4:], names, prior=INDEX, considered=INDEX.names)
    begin = time.process_time()
    adjust(rig, seen, names, prior=INDEX, considered=INDEX.names)
    spent = time.process_time() - begin
    return Figure(
        "joint adjustment of 30 boards and 60 stripes, processor time", spent, "s", at_most=10.0
    )


if __name__ == "__main__":
    main()
