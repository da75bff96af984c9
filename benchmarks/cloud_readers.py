"""Clouds in every format, opened by MeshLab's and by CloudCompare's own readers.

CloudCompare is Debian's: `apt-get install cloudcompare`. That build reads no LAS and no E57.
"""

import os
import shutil
import subprocess
import tempfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from formats import make_cloud
from harness import Figure, skip, tell

from murkscan import PointCloud
from murkscan.io.cloud_files import writing_cloud_file

try:
    # MeshLab's own reader; it is GPL, and only scripts like this one ever import it.
    import pymeshlab
except ImportError as error:
    skip("cloud_readers", f"pymeshlab does not load: {error}.")

SCALARS = ("signal", "posterior", "sigma", "sigma_common", "frame", "scan_line", "laser")
READ_BY_CLOUDCOMPARE = {".ply": len(SCALARS), ".xyz": 0}
READ_BY_MESHLAB = {".ply": 1, ".e57": 0, ".xyz": 0}
"""Scalar fields that the reader can show."""
NOTE = """
A cloud of 24,000 points with normals and seven scalar fields, written by `murkscan cloud OUT
--export` and opened by MeshLab (pymeshlab) and by Debian's CloudCompare, which writes what it has
read as text. "points lost" and "normals lost" count rows that the reader does not show; "moved" is
the largest shift of a point; "scalar fields" counts those that the reader shows with their values
under their names. CloudCompare keeps scalar fields in single precision, in which a frame number is
exact up to 16 million. MeshLab shows one scalar field, of PLY only, whose name is `quality`: the
signal stands there. An .xyz file holds positions and normals. Debian builds CloudCompare without
LAS and E57, and names no column of a .csv file when it is not asked: what is written to those comes
back through laspy, pye57 and our own reader column by column (`tests/io`).
"""


def some_cloud() -> PointCloud:
    """Make a scan of a curved wall whose every column differs from point to point."""
    cloud = make_cloud()
    random = np.random.default_rng(0)

    def column(scale: float) -> np.ndarray:
        return (random.random(len(cloud)) * scale).astype(np.float32)

    return replace(
        cloud, signal=column(200), posterior=column(1), sigma=column(3e-4),
        sigma_common=column(2e-4), laser=random.integers(0, 3, len(cloud)).astype(np.uint8),
    )  # fmt: skip


Shown = tuple[np.ndarray, np.ndarray, dict[str, np.ndarray]]
"""Points, normals, and scalar fields by name."""


def read_by_meshlab(path: Path) -> Shown:
    opened = pymeshlab.MeshSet(verbose=False)
    opened.load_new_mesh(str(path))
    mesh = opened.current_mesh()
    fields = {"signal": mesh.vertex_scalar_array()} if mesh.has_vertex_scalar() else {}
    return mesh.vertex_matrix(), mesh.vertex_normal_matrix(), fields


def read_by_cloudcompare(path: Path) -> Shown:
    told = path.with_suffix(".asc")
    subprocess.run(
        [
            "CloudCompare", "-SILENT", "-O", path.name, "-C_EXPORT_FMT", "ASC", "-PREC", "12",
            "-ADD_HEADER", "-NO_TIMESTAMP", "-SAVE_CLOUDS", "FILE", told.name,
        ],
        cwd=path.parent, env=os.environ | {"QT_QPA_PLATFORM": "offscreen"},
        check=True, capture_output=True, timeout=120,
    )  # fmt: skip
    with told.open() as file:
        names = file.readline().removeprefix("//").split()
        values = dict(zip(names, np.loadtxt(file).T, strict=True))
    points = np.stack([values.pop(name) for name in "XYZ"], axis=1)
    normals = np.stack([values.pop(f"N{name}", points[:, 0] * np.nan) for name in "xyz"], axis=1)
    return points, normals, values


def compare(cloud: PointCloud, shown: Shown, label: str, *, num_fields: int) -> list[Figure]:
    points, normals, fields = shown
    lost = abs(len(points) - len(cloud))
    moved = float(np.abs(points - cloud.points).max()) * 1e3 if lost == 0 else np.nan
    # CloudCompare packs normals into some two million directions, a third of a degree apart.
    off = np.abs(normals - cloud.normals).max(axis=1) > 5e-3 if len(normals) == len(cloud) else [1]
    same = [
        name
        for name in SCALARS
        if name in fields and np.allclose(fields[name], getattr(cloud, name), rtol=1e-6, atol=1e-9)
    ]
    figures = [
        Figure(f"{label}: points lost", lost, at_most=0),
        Figure(f"{label}: moved", moved, "mm", at_most=1e-4),
        Figure(f"{label}: normals lost", int(np.sum(off)), at_most=0),
    ]
    if num_fields:
        figures.append(Figure(f"{label}: scalar fields", len(same), at_least=num_fields))
    return figures


def main() -> None:
    cloud = some_cloud()
    readers: list[tuple[str, Callable[[Path], Shown], dict[str, int]]] = [
        ("MeshLab", read_by_meshlab, READ_BY_MESHLAB)
    ]
    if shutil.which("CloudCompare"):
        readers.append(("CloudCompare", read_by_cloudcompare, READ_BY_CLOUDCOMPARE))
    else:
        print("CloudCompare is not there (apt-get install cloudcompare); only MeshLab is asked.")
    figures = []
    with tempfile.TemporaryDirectory() as folder:
        for name, read, suffixes in readers:
            for suffix, wanted in suffixes.items():
                path = Path(folder) / f"cloud{suffix}"
                with writing_cloud_file(path) as write:
                    write(cloud)
                label = f"{suffix}, {name}"
                figures += compare(cloud, read(path), label, num_fields=wanted)
    tell("cloud_readers", "Clouds, opened by others", figures, note=NOTE)


if __name__ == "__main__":
    main()
