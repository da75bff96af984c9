"""Write clouds of 5 to 20 million points as COPC, and have them opened by other readers."""

import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import laspy
import numpy as np
from harness import Figure, tell

from murkscan.io.cloud_files import writing_cloud_file
from murkscan.types.cloud import PointCloud

BLOCK = 500_000
SIZES = (5, 10, 20)
NOTE = """
A quay wall 8 m high, scanned at 125 000 points a metre, in UTM, with all columns of cloud.ply,
written block by block as the export does, each size in a process of its own. "time" leaves out the
making of the points; "memory" is the process's largest, of which some 200 MB are Python and its
libraries. Read by laspy's COPC reader and by copclib (`pip install copclib`), which also looks
whether every point lies inside of its node; NaN where that is not installed. 10⁹ points are
extrapolated, linearly. Times are of a machine of two cores on which others worked.
"""


def block(number: int) -> PointCloud:
    """Make the points of half a million, 4 m of the wall."""
    random = np.random.default_rng(number)
    x, y = number * 4.0 + random.uniform(0, 4, BLOCK), random.uniform(0, 8, BLOCK)
    z = 0.05 * np.sin(3 * x) * np.cos(2 * y) + 1e-4 * random.standard_normal(BLOCK)
    points = np.stack([432100.0 + x, 5412345.0 + y, z - 12.0], axis=1)
    ones, none = np.ones(BLOCK, np.float32), np.zeros(BLOCK, np.uint8)
    line = np.arange(BLOCK, dtype=np.int32)
    signal = (100 + 20 * random.standard_normal(BLOCK)).round().astype(np.float32)
    sigma = (1e-4 * random.uniform(0.5, 2, BLOCK)).astype(np.float32)
    normals = np.tile(np.array([0, 0, -1], np.float32), (BLOCK, 1))
    frame = number * 100 + line // 5000
    return PointCloud(
        points, normals, signal, ones, sigma, 2 * ones, frame, line % 5000, none, none
    )


def write(path: Path, millions: int) -> None:
    """Write so many, and print how long it took [s] and how much memory [MB]."""
    spent = 0.0
    start = time.perf_counter()
    with writing_cloud_file(path) as put:
        for number in range(2 * millions):
            begin = time.perf_counter()
            made = block(number)
            spent += time.perf_counter() - begin
            put(made)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3
    print(time.perf_counter() - start - spent, memory)


def look_by_laspy(path: Path) -> tuple[int, float]:
    """Count the points that laspy's reader finds, and how far their box is off [m]."""
    count, ends = 0, []
    with laspy.CopcReader.open(path) as reader:
        for level in range(12):
            points = reader.query(level=level)
            if not len(points):
                break
            count += len(points)
            places = np.stack([points.x, points.y, points.z], axis=1)
            ends.append([places.min(axis=0), places.max(axis=0)])
        box = np.array([reader.header.mins, reader.header.maxs])
    low, high = np.array(ends)[:, 0].min(axis=0), np.array(ends)[:, 1].max(axis=0)
    return count, float(np.abs(np.array([low, high]) - box).max())


def look_by_copclib(path: Path) -> tuple[float, float]:
    """Count the points that copclib finds, and whether all lie in their nodes (1: they do)."""
    try:
        import copclib
    except ImportError:
        return float("nan"), float("nan")
    reader = copclib.FileReader(str(path))
    count = sum(node.point_count for node in reader.GetAllNodes())
    return count, float(reader.ValidateSpatialBounds(False))


def main() -> None:
    figures, times, memory = [], [], []
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "wall.copc.laz"
        for millions in SIZES:
            words = (sys.executable, __file__, "write", str(path), str(millions))
            said = subprocess.run(words, capture_output=True, text=True, check=True).stdout
            spent, used = map(float, said.split())
            times.append(spent)
            memory.append(used)
            bar = {"at_most": 120.0} if millions == 20 else {}
            figures.append(Figure(f"{millions} million points, time", spent, "s", **bar))
            bar = {"at_most": 2048.0} if millions == 20 else {}
            figures.append(Figure(f"{millions} million points, memory", used, "MB", **bar))
        size = path.stat().st_size / (SIZES[-1] * 1e6)
        count, off = look_by_laspy(path)
        other, inside = look_by_copclib(path)
    slope, _ = np.polyfit(SIZES, times, 1)
    wanted = SIZES[-1] * 1e6
    figures += [
        Figure("memory, 20 over 5 million", memory[-1] / memory[0], "", at_most=1.2),
        Figure("time, 20 over 5 million", times[-1] / times[0], "", at_most=4.8),
        Figure("10⁹ points, time by these", 1000 * float(slope) / 3600, "h"),
        Figure("bytes a point", size, ""),
        Figure("points lost, by laspy", wanted - count, "", at_most=0, at_least=0),
        Figure("box off, by laspy", 1e3 * off, "mm", at_most=1e-3),
        Figure("points lost, by copclib", wanted - other, ""),
        Figure("points inside of their nodes, by copclib", inside, "1: all"),
    ]
    tell("copc", "Clouds as COPC", figures, note=NOTE)


if __name__ == "__main__":
    if sys.argv[1:2] == ["write"]:
        write(Path(sys.argv[2]), int(sys.argv[3]))
    else:
        main()
