"""Hand-eye on a real robot arm: camera, laser and mount from the same photos, beside the bars.

Run: python benchmarks/arm_poses.py [--data FOLDER]
"""

import argparse
import json
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
    circles_of,
    find_board,
    laser_contrast,
    white_of_board,
)
from murkscan.calibrate.board.stripe import keep_on_board, mask_to_sheet
from murkscan.capture.folder import natural_key
from murkscan.capture.photos import BoardPhotos
from murkscan.extract import AbstractExtractor, GrayGravity, Murk
from murkscan.geometry import fit_plane
from murkscan.io.poses import save_poses
from murkscan.io.rig_toml import load_rig
from murkscan.io.times_csv import write_times
from murkscan.optics import project
from murkscan.survey.calibrate_camera import calibrate_camera_from_photos
from murkscan.survey.calibrate_laser import calibrate_laser_from_photos
from murkscan.survey.calibrate_mount import calibrate_mount_from_photos
from murkscan.triangulate import RaySheet
from murkscan.types.frame import Frame
from murkscan.types.pose import Pose
from murkscan.types.rig import Rig
from murkscan.types.trajectory import Trajectory

BOARD = Chessboard(9, 6, 0.005)
PAPER = Margin(0.03, 0.03, 0.03, 0.03)
"""White paper around the squares, as the photos show it [m]."""
EVERY, HALT = 10.0, 1.0
"""The arm's log has no times: a photo every ten seconds, standing still a second before and after
[s]."""
EXTRACTORS = {
    "gray gravity, window of 12 px, as by default": GrayGravity(),
    "gray gravity, window of 40 px": GrayGravity(half_width=40.0),
    "murk": Murk(),
}
"""The line is up to 50 px wide in these photos."""
CALIBRATES = "gray gravity, window of 40 px"
"""What the laser is calibrated with, and what the bar is for."""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, default=DATA)
    source = parser.parse_args().data / "arm_poses"
    if not source.is_dir():
        skip("arm_poses", f"the real photographs are not in {source.parent}")
    start = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        scratch = Path(folder)
        log = convert(source, scratch)
        photos, rig_path = scratch / "photos", scratch / "rig.toml"
        calibrate_camera_from_photos(photos, BOARD, rig_path, wavelength=640e-9)
        calibrate_laser_from_photos(
            photos, BOARD, rig_path, margin=PAPER, extractor=EXTRACTORS[CALIBRATES]
        )
        result = calibrate_mount_from_photos(photos, BOARD, rig_path, log)
        figures = [*tell_mount(result.calibration)]
        figures += tell_planes(photos, load_rig(rig_path), result.calibration, log)
    figures.append(Figure("time, with pictures", time.perf_counter() - start, "s"))
    tell(
        "arm_poses",
        "Hand-eye on a real robot arm",
        figures,
        note="30 photos of a red line on a 9x6 board of 5 mm squares, at 75 to 135 mm. The sheet "
        "crosses the rays at a flat angle (baseline 18 mm): a pixel is 0.3 to 0.9 mm of range, and "
        "the line is a saturated band of up to 50 px. So the stripe alone, without any error of "
        "pose or scale, bends and scatters by what the last row of each window says. The rest of "
        "the plane's RMS goes with range: the camera's focal length and the sheet, which these "
        "photos tell to some 0.3 mm.",
    )


def convert(source: Path, scratch: Path) -> Trajectory:
    """Lay out photos, times and log as the contracts have them."""
    lines = (source / "data.txt").read_text("utf-8").split("\n")
    entries = sorted(
        zip(lines[2::3], lines[0::3], lines[1::3], strict=False), key=lambda e: natural_key(e[0])
    )
    (scratch / "photos").mkdir()
    for name, _, _ in entries:
        (scratch / "photos" / name.strip()).symlink_to(source / name.strip())
    times = EVERY * np.arange(len(entries))
    names = [name.strip() for name, _, _ in entries]
    write_times(scratch / "photos" / "times.csv", dict(zip(names, times.tolist(), strict=True)))
    positions = np.array([json.loads(position) for _, position, _ in entries])
    quaternions = np.array([json.loads(xyzw) for _, _, xyzw in entries])[:, [3, 0, 1, 2]]
    quaternions /= np.linalg.norm(quaternions, axis=1, keepdims=True)
    log = Trajectory(
        np.repeat(times, 2) + np.tile([-HALT, HALT], len(times)),
        np.repeat(positions, 2, axis=0),
        np.repeat(quaternions, 2, axis=0),
    )
    save_poses(scratch / "poses.csv", log)
    return log


def tell_mount(found: Calibration) -> Iterator[Figure]:
    circles, num_left_out = circles_of(found), len(found.left_out)
    yield Figure("photos with the board, of 30", len(found.sightings) + num_left_out)
    yield Figure("of these left out as outliers", num_left_out)
    yield Figure("hand-eye closes to", circles.closure * 1e3, "mm", at_most=0.4)
    yield Figure("hand-eye closes to, in attitude", float(np.degrees(circles.turn)), "°")
    yield Figure("deviation of the place, largest", float(found.sigma[:3].max()) * 1e3, "mm")
    turn = float(np.degrees(found.sigma[3:].max()))
    yield Figure("deviation of the direction, largest", turn, "°")


def tell_planes(photos: Path, rig: Rig, found: Calibration, log: Trajectory) -> Iterator[Figure]:
    mount, stand = found.rig.vehicle_from_camera, found.adjustment.stand
    assert mount is not None
    assert stand is not None
    for words, extractor in EXTRACTORS.items():
        in_robot, along = [], []
        for number, photo in enumerate(BoardPhotos.open(photos)):
            vehicle = pose_at(log, EVERY * number)
            camera_from_board = (vehicle @ mount).inverse() @ stand.world_from_board
            view = find_board(photo.as_grey(), BOARD, name=photo.name)
            pixels = find_stripe(photo.image, view, rig, camera_from_board, extractor)
            points = RaySheet().locate(pixels, rig, 0)
            in_robot.append(vehicle @ mount @ points)
            along.append(pixels[:, 0])
        residuals = fit_plane(np.concatenate(in_robot), tolerance=np.inf).residuals
        yield Figure(f"{words}: photos with a stripe", sum(len(p) > 0 for p in in_robot))
        yield Figure(f"{words}: stripe points", len(residuals))
        bar = 0.3 if words == CALIBRATES else None
        yield Figure(
            f"{words}: RMS of all points from one plane in the robot's frame",
            rms(residuals),
            "mm",
            at_most=bar,
        )
        ends = np.cumsum([len(points) for points in in_robot])[:-1]
        bent = [
            part - np.polyval(np.polyfit(u, part, 1), u)
            for u, part in zip(along, np.split(residuals, ends), strict=True)
            if len(part)
        ]
        name = f"{words}: the same about a straight line in each photo, whatever its pose"
        yield Figure(name, rms(np.concatenate(bent)), "mm")


def find_stripe(
    image: np.ndarray,
    view: BoardView,
    rig: Rig,
    camera_from_board: Pose,
    extractor: AbstractExtractor,
) -> np.ndarray:
    """Find the stripe on the board's paper, which lies where arm and mount say."""
    corners = project(rig.camera, camera_from_board @ BOARD.points())
    white = np.median(image.reshape(-1, 3), axis=0).astype(float)
    if view.is_found:
        white = white_of_board(image, view, BOARD)
    where = {"camera": rig.camera, "camera_from_board": camera_from_board}
    contrast = mask_to_sheet(
        laser_contrast(image, rig.wavelength, white=white), BOARD, PAPER, **where
    )
    frame = Frame(contrast, 0, 0.0)
    (stripe,) = extractor.extract([frame], rig, extractor.learn([frame], rig))
    placed = view if view.is_found else BoardView("", corners)
    return keep_on_board(stripe.pixels, placed, BOARD, PAPER, **where).pixels


def pose_at(log: Trajectory, time: float) -> Pose:
    here = log.at(np.array([time]))
    return Pose.from_quaternion(here.quaternions, here.positions[0])


def rms(values: np.ndarray) -> float:
    return 1e3 * float(np.sqrt(np.mean(values**2)))


if __name__ == "__main__":
    main()
