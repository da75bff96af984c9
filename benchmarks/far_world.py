"""Scan one recording in a world at 0 and in one at UTM, and compare all that is written."""

import json
import re
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
from harness import Figure, tell

from murkscan.cli.main import run
from murkscan.io.cloud_files import load_cloud_file
from murkscan.io.mesh_files import load_mesh
from murkscan.io.poses import load_poses, save_poses
from murkscan.project import Project
from murkscan.simulate import Body, Scene, Sensor, drive
from murkscan.simulate.shapes import Hull
from murkscan.simulate.textures import Plain
from murkscan.simulate.vehicle import Unrest
from murkscan.survey.shown import load_model
from murkscan.survey.simulate import simulate_recording
from murkscan.types.camera import Camera
from murkscan.types.laser import Laser
from murkscan.types.pose import Pose
from murkscan.types.rig import Rig
from murkscan.view.packing import pack_positions

FAR = np.array([432100.0, 5412345.0, -12.0])
ODD = FAR + np.array([0.123, 0.678, -0.345])
"""The same in no whole number of any format's steps."""
NOTE = """
One simulated recording of a ship model's hull is scanned three times: with its poses as they are,
with 432 km east, 5 412 km north and 12 m below added to them, and with 0.123, 0.678 and 0.345 m
more. What is written is read again; origins that files state are added. "moved" is the largest
difference of any coordinate beside the shift; LAS counts in steps of 0.5 µm from a whole metre. The
page's places are rounded by
design, to the step below.
"""
MEASURES = {
    "area": (), "cylinder": (), "section": ("--normal", "0,1,0"),
    "volume": ("--normal", "0,0,-1"),
}  # fmt: skip


def simulate(folder: Path) -> None:
    """Film the hull in clear air, with a camera of few pixels."""
    times = np.arange(60) / 6
    way = drive(Unrest(), np.array([0.0, 0.1, 0.0]), np.zeros(3), 10.0, seed=0)
    hull = Body(Hull().mesh(), Pose(np.eye(3), np.array([0.0, 0.5, 0.58])), texture=Plain(0.2))
    camera = Camera(size=(360, 288), focal_length=(277.0, 277.0), principal_point=(179.5, 143.5))
    rig = Rig(camera, (Laser.from_baseline_angle(0.25, np.arctan2(0.5, 0.25), "y"),), 532e-9)
    sensor = Sensor(peak_grey=200.0, read_noise=2.0)
    simulate_recording(Scene((hull,), rig, way, times, sensor=sensor), folder)


def scan(recording: Path, out: Path, shift: np.ndarray) -> None:
    """Scan, export and measure in a world that counts from elsewhere."""
    log = load_poses(recording / "poses.csv")
    poses = out.with_suffix(".csv")
    save_poses(poses, replace(log, positions=log.positions + shift))
    rig = ("--rig", str(recording / "rig.toml"), "--poses", str(poses))
    done = run(
        ["scan", str(recording / "frames"), *rig, "--out", str(out), "--extractor", "steger"]
    )
    exports = [f"--export={out}.{suffix}" for suffix in ("laz", "e57", "ply")]
    done += run(["cloud", str(out), *exports])
    point = ",".join(map(repr, (shift + np.array([0.0, 0.4, 0.5])).tolist()))
    for what, arguments in MEASURES.items():
        where = (f"--point-m={point}",) if arguments else ()
        done += run(["measure", str(out), what, *where, *arguments])
    assert done == 0


def moved(near: np.ndarray, far: np.ndarray, shift: np.ndarray) -> float:
    """Give the largest difference beside the shift [µm]; NaN where the counts differ."""
    if near.shape != far.shape:
        return float("nan")
    return float(np.abs(far - shift - near).max()) * 1e6


def corners(path: Path) -> np.ndarray:
    """Give the corners of all triangles in order: STL joins those that are the same number."""
    mesh = load_mesh(path)
    return mesh.vertices[mesh.faces].reshape(-1, 3)


def page(project: Project) -> tuple[np.ndarray, float]:
    """Give places as the page has them, and how coarse they are [µm]."""
    model = load_model(project, most=10**6)
    assert model is not None
    text = (project.root / "view" / "index.html").read_text("utf-8")
    about = json.loads(re.search(r'id="content">(.*?)</script>', text, re.S)[1])
    grid = about["models"][0]["positions"]
    sigma = next(1e-3 * layer.values for layer in model.layers if layer.name == "sigma")
    packed = pack_positions(model.vertices, sigma)
    assert np.allclose(packed.low, grid["low"], rtol=0, atol=1e-9)
    return np.array(grid["low"]) + grid["step"] * packed.codes_of(model.vertices), 1e6 * packed.step


def measures(near: Path, far: Path, shift: np.ndarray) -> float:
    """Give the largest change of any measured number, of lengths in micrometres."""
    most = 0.0
    for what in MEASURES:
        one, other = (
            json.loads((out / "measure" / f"{what}.json").read_text("utf-8"))["quantities"]
            for out in (near, far)
        )
        for key, quantity in one.items():
            value = other[key]["value"]
            if (axis := key.removesuffix("_m")) in ("x", "y", "z"):
                value -= shift["xyz".index(axis)]
            most = max(most, abs(value - quantity["value"]) * 1e6)
    return most


def compare(near: Path, far: Path, shift: np.ndarray, name: str) -> list[Figure]:
    """Compare all that both scans have left."""
    figures = [
        Figure(
            f"{suffix} cloud, moved{name}",
            moved(*(load_cloud_file(Path(f"{out}.{suffix}")).points for out in (near, far)), shift),
            "µm",
            at_most=1.0,
        )
        for suffix in ("ply", "laz", "e57")
    ]
    figures += [
        Figure(
            f"{suffix} surface, moved{name}",
            moved(*(corners(out / "mesh" / f"mesh.{suffix}") for out in (near, far)), shift),
            "µm",
            at_most=10.0 if suffix in ("stl", "glb") else 1.0,
        )
        for suffix in ("ply", "stl", "glb")
    ]
    places = [page(Project(out)) for out in (near, far)]
    off = moved(places[0][0], places[1][0], shift)
    figures.append(Figure(f"page, moved{name}", off, "µm", at_most=max(1.0, 1.01 * places[0][1])))
    figures.append(Figure(f"page, step{name}", places[0][1], "µm"))
    of_measures = measures(near, far, shift)
    return [*figures, Figure(f"measures, moved{name}", of_measures, "µm", at_most=1.0)]


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        recording, figures = Path(folder) / "hull", []
        simulate(recording)
        near = Path(folder) / "near"
        scan(recording, near, np.zeros(3))
        for name, shift in (("", FAR), (", odd shift", ODD)):
            far = Path(folder) / f"far{len(figures)}"
            scan(recording, far, shift)
            figures += compare(near, far, shift, name)
    tell("far_world", "A world in UTM", figures, note=NOTE)


if __name__ == "__main__":
    main()
