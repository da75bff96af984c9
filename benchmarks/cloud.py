"""Clouds larger than memory: time and resident memory, from 20 to 200 million points.

`python benchmarks/cloud.py 20 60` takes some four minutes; without numbers it goes up to 200 and
needs 25 GB of disk.
"""

import json
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from harness import Figure, tell

from murkscan import PointCloud, Project
from murkscan.project import CLOUD, CloudResult
from murkscan.survey.export import export_cloud
from murkscan.types.cloud_part import CloudPart

SIZES = (20, 60, 200)
"""Millions of points."""
LINES = 2000
FRAMES = 250
"""Frames of a part, which hold half a million points."""
VOXEL = 5e-3
LINEAR = 1.25
"""How much longer a point may take in the largest cloud than in the smallest."""
NOTE = f"""
A curved wall, {LINES} points a profile, a profile a millimetre. `to LAZ` writes `cloud.ply` to
`dive.laz` with all columns; `thinned` writes means over voxels of {VOXEL * 1e3:g} mm; both are what
`murkscan cloud OUT --export` does. Each runs in a process of its own, whose largest resident memory
is given. Times are the processor's, of all threads, since the machine is shared. `linear` is the
time a point in the largest cloud over that in the smallest.
"""


def part(number: int) -> PointCloud:
    """Make half a million points: the same ones over and over, each time farther on."""
    random = np.random.default_rng(number % 4)
    count = LINES * FRAMES
    frame = np.repeat(np.arange(FRAMES), LINES)
    line = np.tile(np.arange(LINES), FRAMES)
    y = (line - LINES / 2) * 4e-4
    z = 0.8 + 0.05 * np.sin(4 * y) + random.normal(0, 2e-4, count)
    ones = np.ones(count, np.float32)
    normals = np.tile(np.array([0, 0, -1], np.float32), (count, 1))
    number_of_frame = (frame + number * FRAMES).astype(np.int32)
    return PointCloud(
        np.stack([number_of_frame * 1e-3, y, z], axis=1), normals, ones * 90, ones,
        ones * np.float32(2e-4), ones * np.float32(1e-4), number_of_frame,
        line.astype(np.int32), *np.zeros((2, count), np.uint8),
    )  # fmt: skip


def parts(millions: int) -> Iterator[PointCloud]:
    return (part(number) for number in range(2 * millions))


def make_project(root: Path, millions: int) -> Project:
    """Write a finished cloud stage."""
    project = Project(root)
    stage = project.stage(CLOUD, settings={}, inputs={})
    since = time.monotonic()
    stage.begin()
    for number, cloud in enumerate(parts(millions)):
        project.save_cloud_part(number, CloudPart.whole(cloud))
    stage.finish(CloudResult(millions * 1_000_000, outliers=0), since=since)
    return project


def work(root: Path, name: str) -> None:
    """Do one export in this process, and tell what it took."""
    voxel = VOXEL if name == "thinned" else None
    path = root / ("thin.ply" if voxel else "dive.laz")
    start = time.process_time()
    count = export_cloud(Project(root / "scan"), path, voxel=voxel)
    seconds = time.process_time() - start
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    print(json.dumps({"seconds": seconds, "bytes": peak, "count": count}))


def measure(millions: int) -> dict[str, dict[str, float]]:
    with tempfile.TemporaryDirectory(dir=".") as folder:
        make_project(Path(folder) / "scan", millions)
        return {name: run_apart(folder, name) for name in ("to LAZ", "thinned")}


def run_apart(folder: str, name: str) -> dict[str, float]:
    command = [sys.executable, __file__, "--worker", folder, name]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    return json.loads(done.stdout.splitlines()[-1])


def main() -> None:
    sizes = [int(number) for number in sys.argv[1:]] or list(SIZES)
    measured = {millions: measure(millions) for millions in sizes}
    figures = []
    for millions, by_name in measured.items():
        for name, took in by_name.items():
            label = f"{millions} million points, {name}"
            figures.append(Figure(label, took["seconds"], "s"))
            figures.append(Figure(f"{label}: resident", took["bytes"] / 2**30, "GiB", at_most=4.0))
    for name in ("to LAZ", "thinned"):
        each = {m: by_name[name]["seconds"] / m for m, by_name in measured.items()}
        ratio = each[max(each)] / each[min(each)]
        figures.append(Figure(f"{name}: linear", ratio, at_most=LINEAR))
    tell("cloud", "Clouds larger than memory", figures, note=NOTE)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--worker"]:
        work(Path(sys.argv[2]), sys.argv[3])
    else:
        main()
