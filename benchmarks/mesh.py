"""How near the surfaces of a hull in murk lie to the true one, how whole they are, and their time.

`python benchmarks/mesh.py --cache FOLDER` keeps the recording and its cloud for the next time.
"""

import argparse
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from harness import Figure, tell
from scipy.spatial import KDTree

from murkscan import (
    ConstantSpeed,
    GridMesh,
    Mesh,
    MissingDependency,
    Murk,
    PointCloud,
    Poisson,
    Project,
    load_rig,
    open_recording,
)
from murkscan.geometry.closest import Closest, face_normals, find_closest
from murkscan.geometry.grid import NONE, ScanGrid
from murkscan.geometry.point_normals import estimate_point_normals
from murkscan.io.mesh_files import load_mesh
from murkscan.io.parquet import load_true_stripe
from murkscan.io.poses import load_poses
from murkscan.mesh import AbstractMesher, close_holes, decimate
from murkscan.simulate import Recorder, load_scene
from murkscan.survey.cloud import build_cloud
from murkscan.survey.extract import extract_recording
from murkscan.survey.motion import follow_motion
from murkscan.survey.scan import begin_scan
from murkscan.survey.simulate import simulate_recording
from murkscan.survey.triangulate import triangulate_stripes
from murkscan.triangulate import RaySheet

SCENE, SPEED, PICTURES = "hull-c1.5", 0.125, 60
"""The scene, how fast its camera moves [m/s], and how many pictures of its middle are taken."""
WALL = 1.3
"""What is farther than this is the wall behind the hull [m]."""
WITHIN = 0.02
"""Distance up to which a place counts as the surface's [m]; what is farther counts with this."""
ALONG, ACROSS, TURN, STEP = 12, 4, np.radians(15.0), 1.5e-3
"""A place is smooth if within so many scan lines and profiles the true surface turns by no more
than this angle and leaves the tangent plane by no more than this length [m]."""
FOUND = 1e-3
"""A true place is on a mesh that passes it no farther away than this [m]."""
SAMPLES = 30_000
MILLION = 1_000_000
DROPOUTS = 0.01
"""Share of the points that are missing from the cloud of a million, one here and one there."""
RATIO, SECONDS = 0.8, 30.0
MESHERS: dict[str, AbstractMesher] = {
    "GridMesh": GridMesh(),
    "GridMesh, smoothing = 0": GridMesh(smoothing=0.0),
    "Poisson": Poisson(),
}
NOTE = f"""
The scene `{SCENE}`, {PICTURES} pictures ({2 * PICTURES} fields) of its middle: a hull 0.8 to 1.05 m
away and a wall behind it, scanned with the default finder. RMS errors are distances of vertices
from the true surface along its normal; those of the cloud are its points'. *Smooth* is where the
true surface turns by less than {np.degrees(TURN):g}° and stays within {STEP * 1e3:g} mm of its
tangent plane over {ALONG} scan lines and {ACROSS} profiles to each side; all else is *edges*:
keels, the through-hull, and the outline before the wall. *Completeness* is the share of the true
stripe's places that lie within {FOUND * 1e3:g} mm of the mesh. Hausdorff distances are the largest
of {SAMPLES:,} places, spread over the mesh or over the true stripe, and not looked for beyond
{WITHIN * 1e3:g} mm.

The default finder has joined centres over eight scan lines and two fields to each side already;
what smoothing gains, it gains over three and four times as many. The times are for one million
points in grid order, profiles of 1000 of which one in {1 / DROPOUTS:g} is missing, each in one
thread, by the clock of a machine that is shared.
"""


@dataclass(frozen=True)
class Judged:
    """A cloud, and what is true of it."""

    cloud: PointCloud
    truth: Mesh
    true_places: np.ndarray
    errors: np.ndarray
    is_smooth: np.ndarray


def scan_hull(folder: Path) -> Project:
    """Simulate the recording and scan it up to the cloud; what is there is taken."""
    scene = load_scene(SCENE)
    first = len(scene) // 2 - PICTURES
    part = slice(first - first % 2, first - first % 2 + 2 * PICTURES)
    recorded = folder / "recording"
    if not (recorded / "truth" / "stripes.parquet").exists():
        scene = replace(scene, times=scene.times[part], recorder=Recorder("ffv1"))
        simulate_recording(scene, recorded)
    rig = load_rig(recorded / "rig.toml")
    recording = open_recording(recorded / "recording.mkv", fields="top-first")
    project = Project(folder / "scan")
    begin_scan(project, recording, rig, settings={})
    extract_recording(project, recording, rig, Murk())
    triangulate_stripes(project, rig, RaySheet())
    follow_motion(project, ConstantSpeed(SPEED, rig.lasers[0].axis))
    build_cloud(project, rig)
    return project


def judge(folder: Path) -> Judged:
    """Scan, and hold the cloud against the truth, moved to where the scan begins."""
    cloud = scan_hull(folder).load_cloud()
    recorded = folder / "recording"
    truth = load_mesh(recorded / "truth" / "mesh.ply")
    stripe = load_true_stripe(recorded / "truth" / "stripes.parquet")
    places = stripe.points[:: max(len(stripe) // SAMPLES, 1)]
    start = load_poses(recorded / "poses.csv").positions[0]
    truth, places = replace(truth, vertices=truth.vertices - start), places - start
    found = find_closest(cloud.points, truth, within=WITHIN)
    return Judged(cloud, truth, places, _signed(cloud.points, truth, found),
                  _find_smooth(cloud, truth, found))  # fmt: skip


def _signed(points: np.ndarray, truth: Mesh, found: Closest) -> np.ndarray:
    """Give the distance along the true normal; NaN where there is no surface."""
    normals = face_normals(truth)[found.face]
    errors = np.einsum("ij,ij->i", points - found.places, normals)
    return np.where(found.face < 0, np.nan, errors)


def _find_smooth(cloud: PointCloud, truth: Mesh, found: Closest) -> np.ndarray:
    """Tell which points lie where the true surface is even, as far as the scan has seen it."""
    grid, normals = ScanGrid.from_cloud(cloud), face_normals(truth)[found.face]
    smooth = found.face >= 0
    profile, line = grid.profile - grid.profile.min(), grid.line - grid.line.min()
    cells = np.full((profile.max() + 1 + 2 * ACROSS, line.max() + 1 + 2 * ALONG), NONE)
    cells[profile + ACROSS, line + ALONG] = np.arange(len(cloud))
    for across in range(-ACROSS, ACROSS + 1):
        for along in range(-ALONG, ALONG + 1):
            there = cells[profile + ACROSS + across, line + ALONG + along]
            turned = np.einsum("ij,ij->i", normals, normals[there]) < np.cos(TURN)
            between = found.places[there] - found.places
            stepped = np.abs(np.einsum("ij,ij->i", between, normals)) > STEP
            smooth &= (there == NONE) | ~(turned | stepped)
    return smooth


def measure_mesh(name: str, mesh: Mesh, judged: Judged) -> Iterator[Figure]:
    """Give the figures of one mesh."""
    truth, cloud = judged.truth, judged.cloud
    found = find_closest(mesh.vertices, truth, within=WITHIN)
    errors = _signed(mesh.vertices, truth, found)
    nearest = _nearest(cloud.points, mesh.vertices)
    is_smooth, is_hull = judged.is_smooth[nearest], cloud.points[nearest, 2] < WALL
    of_cloud = cloud.points[:, 2] < WALL
    bar = RATIO if name == "GridMesh" else None
    for part, here, there in (
        ("hull, smooth", is_smooth & is_hull, judged.is_smooth & of_cloud),
        ("wall, smooth", is_smooth & ~is_hull, judged.is_smooth & ~of_cloud),
        ("edges", ~is_smooth, ~judged.is_smooth),
    ):
        own, before = _rms(errors[here]), _rms(judged.errors[there])
        yield Figure(f"{name}: RMS, {part}", own * 1e3, "mm")
        at_most = bar if part != "edges" else None
        yield Figure(f"{name}: RMS, {part}, by the cloud's", own / before, at_most=at_most)
    sampled, _ = trimesh.sample.sample_surface(
        trimesh.Trimesh(mesh.vertices, mesh.faces, process=False), SAMPLES, seed=0
    )
    out = find_closest(np.asarray(sampled, float), truth, within=WITHIN).distance
    back = find_closest(judged.true_places, mesh, within=WITHIN).distance
    yield Figure(f"{name}: completeness", 100 * float(np.mean(back <= FOUND)), "%")
    yield Figure(f"{name}: Hausdorff, mesh to truth", _largest(out), "mm")
    yield Figure(f"{name}: 99 % of it", 1e3 * float(np.percentile(out, 99)), "mm")
    yield Figure(f"{name}: Hausdorff, truth to mesh", _largest(back), "mm")
    yield Figure(f"{name}: triangles", len(mesh.faces))


def _nearest(points: np.ndarray, places: np.ndarray) -> np.ndarray:
    return np.asarray(KDTree(points).query(places)[1])


def _rms(errors: np.ndarray) -> float:
    return float(np.sqrt(np.nanmean(errors**2)))


def _largest(distances: np.ndarray) -> float:
    return 1e3 * float(np.minimum(distances, WITHIN).max())


def wall_of(count: int) -> PointCloud:
    """Make a curved wall in grid order, with noise of 0.2 mm that its points state."""
    lines = 1000
    frame, line = np.divmod(np.arange(count), lines)
    x, y = frame * 1e-3, (line - lines / 2) * 4e-4
    random = np.random.default_rng(0)
    z = 0.8 + 0.02 * np.sin(8 * y) * np.cos(5 * x) + random.normal(0, 2e-4, count)
    ones = np.ones(count, np.float32)
    return PointCloud(
        np.stack([x, y, z], axis=1), np.tile(np.array([0, 0, -1], np.float32), (count, 1)),
        ones * 90, ones, ones * np.float32(2e-4), ones * np.float32(1e-4),
        frame.astype(np.int32), line.astype(np.int32), *np.zeros((2, count), np.uint8),
    )  # fmt: skip


def measure_time() -> Iterator[Figure]:
    """Time every mesher on a million points, and what is done afterwards."""
    cloud = wall_of(round(MILLION / (1 - DROPOUTS)))
    cloud = cloud[np.random.default_rng(1).random(len(cloud)) >= DROPOUTS]
    GridMesh().mesh(cloud[:10_000])
    for name, mesher in available():
        bar = SECONDS if name == "GridMesh" else None
        seconds, mesh = _timed(lambda mesher=mesher: mesher.mesh(cloud))
        yield Figure(f"{name}: one million points", seconds, "s", at_most=bar)
        if name == "GridMesh":
            seconds, _ = _timed(lambda mesh=mesh: close_holes(mesh, largest=0.01))
            yield Figure("close its ten thousand holes", seconds, "s")
            seconds, _ = _timed(lambda mesh=mesh: decimate(mesh, faces=100_000))
            yield Figure("thin them out to 100 000", seconds, "s")


def compare_pieces() -> Figure:
    """Compare the normals of 2500 pieces, 0.1 m apart, with those of as many points of one."""
    x, y = (part.ravel() for part in np.meshgrid(np.arange(7) * 1e-3, np.arange(7) * 1e-3))
    row, column = (part.ravel()[:, None] for part in np.indices((50, 50)))
    tilted = np.where((row + column) % 2, x, -x)
    seconds = []
    for gap in (7e-3, 0.1):
        points = np.stack([row * gap + x, column * gap + y, tilted], axis=-1).reshape(-1, 3)
        seconds.append(_timed(partial(estimate_point_normals, points))[0])
    return Figure("normals of 2500 pieces, over those of one", seconds[1] / seconds[0], at_most=1.5)


def _timed(run: Callable[[], Any]) -> tuple[float, Any]:
    start = time.perf_counter()
    made = run()
    return time.perf_counter() - start, made


def available() -> Iterator[tuple[str, AbstractMesher]]:
    """Give the meshers that are installed here."""
    for name, mesher in MESHERS.items():
        try:
            mesher.check_available()
        except MissingDependency as error:
            print(f"{name} is left out: {error}")
        else:
            yield name, mesher


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--cache", type=Path)
    cache = parser.parse_args().cache
    with tempfile.TemporaryDirectory() as folder:
        judged = judge(cache or Path(folder))
    figures = [Figure("cloud: points", len(judged.cloud))]
    figures.append(Figure("cloud: smooth points", 100 * float(judged.is_smooth.mean()), "%"))
    for name, mesher in available():
        figures += measure_mesh(name, mesher.mesh(judged.cloud), judged)
    figures += [*measure_time(), compare_pieces()]
    tell("mesh", "Surfaces of a hull in murky water", figures, note=NOTE)


if __name__ == "__main__":
    main()
