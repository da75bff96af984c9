"""How often the truth lies within the stated intervals: calibrate, triangulate, compare, repeat.

Run: python benchmarks/uncertainty.py [--calibrations 400]
"""

import argparse
import time
from dataclasses import dataclass

import numpy as np
from harness import Figure, tell
from scipy.spatial.transform import Rotation

from murkscan.calibrate import Chessboard
from murkscan.calibrate.adjust.observations import Sighting
from murkscan.calibrate.adjust.parameters import INTRINSICS, port_parameters, sheet_parameters
from murkscan.calibrate.adjust.solve import adjust
from murkscan.optics import perturb_rig, project, refractive_index
from murkscan.optics.uncertainty import common_covariances, common_sigma
from murkscan.triangulate import RaySheet, triangulate
from murkscan.types.camera import Camera
from murkscan.types.laser import Laser
from murkscan.types.plane import Plane
from murkscan.types.port import FlatPort, Layer
from murkscan.types.pose import Pose
from murkscan.types.rig import Rig
from murkscan.types.rig_covariance import RigCovariance
from murkscan.types.stripe import Stripe
from murkscan.types.water import Water

BOARD = Chessboard(9, 6, 0.04)
PORT = FlatPort(np.array([np.sin(0.035), 0.0, np.cos(0.035)]), 0.03, (Layer(0.008, 1.49),))
CAMERA = Camera(
    (1920, 1200), (1400.0, 1402.0), (961.0, 597.0), np.array([-0.1, 0.03, 0.0, 0.0, 0.0]), PORT
)
SHEET = Plane.through(np.array([-0.25, 0.0, 0.0]), np.array([-0.97, 0.0, 0.2425]) / 0.99988)
RIG = Rig(CAMERA, (Laser.from_sheet(Plane(SHEET.normal, SHEET.distance)),), water=Water(20.0, 0.0))
NAMES = (*INTRINSICS, *port_parameters(PORT), *sheet_parameters(RIG.lasers[0], 0))
BEFORE = np.array([2, 2, 3, 3, *[2e-3] * 5, 0.02, 0.02, 2e-3, 0.02, 0.02, 5e-3])
"""What is known beforehand: an air calibration, a ruler; as standard deviations."""
INDEX_SIGMA = 1e-4
"""Of the index of water: a degree of temperature [-]."""
NUM_BOARDS, NUM_LINES, NUM_POINTS = 12, 12, 10
CORNER_NOISE = 0.1
RANGES = (0.5, 2.0)
WIDTH = 2.0
"""Standard deviation of the stripe's profile [px]."""
CONTRASTS = (10.0, 100.0)
"""Peak of the stripe over the noise of one pixel."""
SHARES = {68: (64.0, 72.0, 1.0), 95: (92.5, 97.0, 1.96)}
"""Bars of an interval's coverage [%], and its half width in standard deviations."""


@dataclass(frozen=True)
class Trial:
    """Errors of points over their stated deviations, of one calibration."""

    independent: np.ndarray
    total: np.ndarray
    columns: np.ndarray
    """As `total`, with the two columns of cloud.ply."""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--calibrations", type=int, default=400)
    count = parser.parse_args().calibrations
    start = time.perf_counter()
    trials = [run_trial(np.random.default_rng(seed)) for seed in range(count)]
    figures = []
    for name, words in [
        ("independent", "independent part alone"),
        ("total", "total, along the ray"),
        ("columns", "total, by the columns of cloud.ply"),
    ]:
        pulls = np.stack([getattr(trial, name) for trial in trials])
        for share in SHARES:
            figures += cover(words, pulls, share, has_bar=name != "columns")
        spread = float(np.sqrt(np.mean(pulls**2)))
        figures.append(Figure(f"{words}: RMS of error over deviation", spread))
    figures.append(Figure("time", time.perf_counter() - start, "s"))
    tell(
        "uncertainty",
        f"Coverage: {count} simulated calibrations, {NUM_POINTS} points each",
        figures,
        note=f"Camera behind a tilted port in fresh water, {NUM_BOARDS} photos of a board and "
        f"{NUM_LINES} of the laser's line on it, corners to {CORNER_NOISE} px, stripes at the "
        "Cramér-Rao bound of a Gaussian stripe with a contrast of 10 to 100. Points at "
        f"{RANGES[0]} to {RANGES[1]} m. Beside each share stand two standard deviations of chance: "
        "the binomial one, or that from calibration to calibration where it is larger, since ten "
        "points share the error of theirs. The column sigma_common is the deviation in the "
        "direction in which it is largest, so along the ray it is careful and has no bar.",
    )


def cover(words: str, pulls: np.ndarray, share: int, *, has_bar: bool) -> tuple[Figure, Figure]:
    """Give the share of errors within an interval, and what chance leaves it."""
    least, most, width = SHARES[share]
    inside = np.abs(pulls) <= width
    held = float(inside.mean())
    binomial = np.sqrt(held * (1 - held) / inside.size)
    from_trial_to_trial = inside.mean(axis=1).std(ddof=1) / np.sqrt(len(inside))
    chance = 200 * float(max(binomial, from_trial_to_trial))
    name = f"{words}: {share} % intervals hold"
    bars = {"at_least": least, "at_most": most} if has_bar else {}
    note = f" ({least:g} to {most:g})" if has_bar else ""
    return Figure(name + note, 100 * held, "%", **bars), Figure(f"{name}, ± 2 σ", chance, "%")


def run_trial(random: np.random.Generator) -> Trial:
    """Calibrate on noisy photos from a rig that is known roughly, and measure ten points."""
    index = RigCovariance(("water.index",), np.array([[INDEX_SIGMA**2]]))
    names = (*NAMES, *index.names)
    before = np.append(BEFORE, INDEX_SIGMA)
    prior = RigCovariance(names, np.diag(before) ** 2)
    begin = perturb_rig(RIG, names, random.normal(size=len(before)) * before)
    seen = [see(random, number, with_line=number >= NUM_BOARDS)
            for number in range(NUM_BOARDS + NUM_LINES)]  # fmt: skip
    rig = adjust(begin, seen, NAMES, prior=prior, considered=index.names).rig
    pixels, truth = pick_points(random)
    contrast = np.exp(random.uniform(*np.log(CONTRASTS), NUM_POINTS))
    sigma = 1.062 * np.sqrt(WIDTH) / contrast
    noisy = pixels + np.stack([random.normal(0, sigma), np.zeros(NUM_POINTS)], axis=1)
    profile = triangulate(as_stripe(noisy, sigma), rig, RaySheet())
    clean = RaySheet().locate(pixels, rig, 0)
    along = profile.points / np.linalg.norm(profile.points, axis=1, keepdims=True)
    common = np.einsum("ni,nij,nj->n", along, common_covariances(noisy, rig), along)
    error = np.sum((profile.points - truth) * along, axis=1)
    own = np.linalg.norm(profile.points, axis=1) - np.linalg.norm(clean, axis=1)
    return Trial(
        own / profile.sigma,
        error / np.sqrt(profile.sigma**2 + common),
        error / np.hypot(profile.sigma, common_sigma(noisy, rig)),
    )


def see(random: np.random.Generator, number: int, *, with_line: bool) -> Sighting:
    """Photograph the board, and the line across it."""
    flat, size = BOARD.points(), np.array(RIG.camera.size)
    water = refractive_index(RIG.water, RIG.wavelength)
    while True:
        turned = Rotation.from_euler("xyz", random.uniform(-30, 30, 3), degrees=True).as_matrix()
        depth = random.uniform(0.5, 2.0)
        aside = random.uniform(-0.4, 0.4, 2) * depth * size / RIG.camera.focal_length
        pose = Pose(turned, np.array([*aside, depth]) - turned @ flat.mean(axis=0))
        corners = project(RIG.camera, pose @ flat, water)
        line = cross(pose)
        in_view = np.all((corners > 5) & (corners < size - 6))
        if in_view and (not with_line or len(line) >= 20):
            break
    corners = corners + random.normal(0, CORNER_NOISE, corners.shape)
    if not with_line:
        return Sighting(f"board{number}", corners, flat, pose)
    line = line + np.stack([random.normal(0, CORNER_NOISE, len(line)), 0 * line[:, 0]], axis=1)
    return Sighting(f"line{number}", corners, flat, pose, line)


def cross(camera_from_board: Pose) -> np.ndarray:
    """Give the pixels at which the sheet crosses the board's squares, one an image row or so."""
    sheet = RIG.lasers[0].sheet
    assert isinstance(sheet, Plane)
    plane = Plane.through(camera_from_board.translation, camera_from_board.rotation[:, 2])
    along = np.cross(sheet.normal, plane.normal)
    along /= np.linalg.norm(along)
    middle = np.linalg.solve(
        np.stack([sheet.normal, plane.normal, along]),
        [-sheet.distance, -plane.distance, along @ camera_from_board.translation],
    )
    points = middle + np.linspace(-0.5, 0.5, 400)[:, None] * along
    x, y, _ = (camera_from_board.inverse() @ points).T / BOARD.square
    inside = (x > -1) & (x < BOARD.columns) & (y > -1) & (y < BOARD.rows)
    pixels = project(RIG.camera, points[inside], refractive_index(RIG.water, RIG.wavelength))
    return pixels[np.all((pixels > 0) & (pixels < np.array(RIG.camera.size) - 1), axis=1)]


def pick_points(random: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Give ten pixels far apart, and the true points of the sheet that they see."""
    pixels, points = np.zeros((0, 2)), np.zeros((0, 3))
    width, height = RIG.camera.size
    while len(pixels) < NUM_POINTS:
        tried = random.uniform((0, 0), (width - 1, height - 1), (1, 2))
        point = RaySheet().locate(tried, RIG, 0)
        is_far = np.all(np.linalg.norm(pixels - tried, axis=1) > 60)
        if is_far and RANGES[0] <= np.linalg.norm(point) <= RANGES[1]:
            pixels, points = np.concatenate([pixels, tried]), np.concatenate([points, point])
    return pixels, points


def as_stripe(pixels: np.ndarray, sigma: np.ndarray) -> Stripe:
    count = len(pixels)
    ratio, number = np.ones(count, np.float32), np.zeros(count, np.uint8)
    return Stripe(
        np.zeros(count, np.uint32), np.zeros(count), pixels, sigma.astype(np.float32),
        ratio, ratio, number, number,
    )  # fmt: skip


if __name__ == "__main__":
    main()
