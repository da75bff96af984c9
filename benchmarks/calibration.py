"""Calibrate cameras and a laser on real photographs, beside the bars.

Run: python benchmarks/calibration.py [--data FOLDER]
"""

import argparse
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from harness import DATA, Figure, skip, tell

from murkscan.calibrate import (
    BoardView,
    Calibration,
    Chessboard,
    Margin,
    calibrate_camera,
    sheet_of,
)
from murkscan.calibrate.adjust.observations import Sighting
from murkscan.errors import Degenerate
from murkscan.extract import GrayGravity, Murk
from murkscan.survey.calibrate_camera import calibrate_camera_from_photos
from murkscan.survey.calibrate_laser import calibrate_laser_from_photos

PAPER = Margin(left=0.115, right=0.08, top=0.06, bottom=0.065)
"""The white paper of the green laser's board beyond its squares, as its photos show it [m]."""
RESAMPLES = 40
"""Sets of views drawn for a bootstrap: a deviation is then known to a tenth."""
AUTHORS = np.array([702.6, 703.5])
"""Focal lengths that the author of underwater_line gives [px]."""
NORMAL, DISTANCE = np.array([-0.9057, 0.1395, -0.4004]), 0.1657
"""The reference plane in the data's README, from an independent fit [m]."""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, default=DATA)
    data = parser.parse_args().data
    if not (data / "green_laser").is_dir():
        skip("calibration", f"the real photographs are not in {data}")
    start = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        scratch = Path(folder)
        cameras = list(measure_cameras(data, scratch))
        reason = refusal_of_parallel_boards(data, scratch)
        lasers = list(measure_laser(data, scratch))
    refused = Figure("stage_stairs/board: refused as degenerate", float(bool(reason)), at_least=1)
    spent = Figure("time, with pictures", time.perf_counter() - start, "s")
    tell(
        "calibration",
        "Calibration on real photographs",
        [*cameras, refused, *lasers, spent],
        note=f"stage_stairs/board is refused with: {reason}",
    )


def measure_cameras(data: Path, scratch: Path) -> Iterator[Figure]:
    for folder, board, bar, count in [
        ("chessboards", Chessboard(9, 6, 0.03), 0.22, 13),
        ("green_laser/board", Chessboard(8, 6, 0.04), 0.16, 27),
        ("underwater_line/air", Chessboard(8, 7, 0.0338), None, 6),
    ]:
        result = calibrate_camera_from_photos(
            data / folder, board, scratch / f"{Path(folder).parts[0]}.toml"
        )
        camera, sigma = result.calibration.rig.camera, result.calibration.sigma
        found = len(result.calibration.sightings)
        yield Figure(f"{folder}: RMS", result.calibration.rms, "px", at_most=bar)
        yield Figure(f"{folder}: boards found of {count}", found, at_least=count)
        yield Figure(f"{folder}: focal length", camera.focal_length[0], "px")
        yield Figure(f"{folder}: its standard deviation", float(sigma[0]), "px")
        if folder == "underwater_line/air":
            off = np.max(np.abs(np.array(camera.focal_length) / AUTHORS - 1))
            yield Figure(f"{folder}: focal lengths off the author's", 100 * off, "%", at_most=1.0)
            continue
        ratios = sigma / bootstrap(result.calibration, board)
        yield Figure(f"{folder}: least stated deviation over bootstrap", float(ratios.min()))
        yield Figure(f"{folder}: largest stated deviation over bootstrap", float(ratios.max()))


def bootstrap(calibration: Calibration, board: Chessboard) -> np.ndarray:
    """Give the standard deviation of each parameter over resampled sets of views."""
    random, found = np.random.default_rng(0), []
    views = [as_view(sighting, board) for sighting in calibration.sightings]
    for _ in range(RESAMPLES):
        some = [views[i] for i in random.integers(len(views), size=len(views))]
        camera = calibrate_camera(some, board, calibration.rig.camera.size).rig.camera
        found.append([*camera.focal_length, *camera.principal_point, *camera.distortion])
    return np.std(found, axis=0, ddof=1)


def as_view(sighting: Sighting, board: Chessboard) -> BoardView:
    """Number the corners of a sighting again."""
    column, row, _ = np.rint(sighting.points / board.square).astype(int).T
    return BoardView(sighting.name, sighting.corners, numbers=row * board.columns + column)


def refusal_of_parallel_boards(data: Path, scratch: Path) -> str:
    board = Chessboard(5, 5, 0.005)
    try:
        calibrate_camera_from_photos(data / "stage_stairs/board", board, scratch / "stage.toml")
    except Degenerate as error:
        return str(error).split(" The photos with")[0]
    return ""


def measure_laser(data: Path, scratch: Path) -> Iterator[Figure]:
    for words, margin, extractor, bars in [
        ("paper given", PAPER, GrayGravity(), (0.45, 0.5, 2.0)),
        ("paper given, murk", PAPER, Murk(), (None, None, None)),
        ("default margin", None, GrayGravity(), (None, None, None)),
    ]:
        result = calibrate_laser_from_photos(
            data / "green_laser/laser_on_board",
            Chessboard(8, 6, 0.04),
            scratch / "green_laser.toml",
            margin=margin,
            extractor=extractor,
        )
        found = sheet_of(result.calibration, 0)
        points = np.concatenate(found.points)[np.concatenate(found.inliers)]
        turn = np.linalg.norm(np.cross(found.sheet.normal, NORMAL / np.linalg.norm(NORMAL)))
        off = float(np.abs(points @ NORMAL + DISTANCE).max())
        about = f"laser_on_board, {words}"
        yield Figure(f"{about}: RMS", found.rms * 1e3, "mm", at_most=bars[0])
        yield Figure(
            f"{about}: angle to the reference plane",
            float(np.degrees(np.arcsin(turn))),
            "°",
            at_most=bars[1],
        )
        yield Figure(
            f"{about}: farthest stripe point from the reference plane",
            off * 1e3,
            "mm",
            at_most=bars[2],
        )
        yield Figure(f"{about}: photos used of {result.num_photos}", len(found.stripes))
        yield Figure(f"{about}: stripe points", found.num_points)
        yield Figure(f"{about}: of these on the sheet", found.num_inliers)


if __name__ == "__main__":
    main()
