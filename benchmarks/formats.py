"""Write every format that a scan leaves behind, and have it opened by those who will open it."""

import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import trimesh
from harness import Figure, skip, tell

from murkscan import GridMesh, Mesh, PointCloud
from murkscan.io.mesh_files import save_mesh
from murkscan.io.mlp import frame_name, save_project, split_frames
from murkscan.io.ply import save_cloud

try:
    # MeshLab's own reader; it is GPL, and only this script ever imports it.
    import pymeshlab
except ImportError as error:
    skip("formats", f"pymeshlab does not load: {error}. It needs libgl1, libegl1 and libopengl0.")

FRAMES, LINES = 60, 400
NOTE = """
A cloud and a mesh of a curved wall, written by murkscan and opened by MeshLab's own reader
(pymeshlab) and by trimesh. "lost" counts vertices, and triangles where there are any, that the
reader does not show; "moved" is the largest shift of a corner of the bounding box: PLY keeps double
precision, STL and GLB single. GLB has y up and z towards the viewer; it is turned back before it is
compared.
"""


def make_cloud() -> PointCloud:
    """Make a scan of a curved wall."""
    frame, line = (g.ravel().astype(np.int32) for g in np.mgrid[:FRAMES, :LINES])
    x, y = frame * 1e-3, line * 3e-4
    points = np.stack([x, y, 0.5 + 0.02 * np.sin(40 * x) * np.cos(30 * y)], axis=1)
    normals = np.tile(np.array([0, 0, -1], np.float32), (len(points), 1))
    ones = np.ones(len(points), np.float32)
    laser = np.zeros(len(points), np.uint8)
    return PointCloud(points, normals, *[ones] * 4, frame, line, laser, laser)


def read_by_meshlab(path: Path) -> tuple[int, int, np.ndarray]:
    """Give vertices, triangles, and the corners of the bounding box."""
    opened = pymeshlab.MeshSet(verbose=False)
    if path.suffix == ".mlp":
        opened.load_project(str(path))
    else:
        opened.load_new_mesh(str(path))
    parts = [opened.mesh(number) for number in range(len(opened))]
    vertices = np.concatenate([part.vertex_matrix() for part in parts])
    return len(vertices), sum(part.face_number() for part in parts), bounds(vertices)


def read_by_trimesh(path: Path) -> tuple[int, int, np.ndarray]:
    """Give vertices, triangles, and the corners of the bounding box."""
    opened = trimesh.load(path, force="mesh" if path.suffix == ".glb" else None)
    vertices = np.asarray(opened.vertices)
    return len(vertices), len(getattr(opened, "faces", ())), bounds(vertices)


def bounds(vertices: np.ndarray) -> np.ndarray:
    return np.stack([vertices.min(axis=0), vertices.max(axis=0)])


def compare(
    name: str,
    path: Path,
    vertices: np.ndarray,
    num_faces: int,
    read: Callable[[Path], tuple[int, int, np.ndarray]],
) -> list[Figure]:
    """Give what a reader loses and moves."""
    num_vertices, faces, box = read(path)
    if path.suffix == ".glb":
        box = bounds(box * [1, -1, -1])
    moved = float(np.abs(box - bounds(vertices)).max()) * 1e3
    # Single precision resolves 0.5 m to 3e-5 mm.
    allowed = 1e-9 if path.suffix in (".ply", ".mlp") else 3e-5
    lost = abs(num_vertices - len(vertices)) + abs(faces - num_faces)
    return [
        Figure(f"{name}: lost", lost, at_most=0),
        Figure(f"{name}: moved", moved, "mm", at_most=allowed),
    ]


def write_all(folder: Path, cloud: PointCloud, mesh: Mesh) -> list[tuple[str, Path, np.ndarray]]:
    save_cloud(folder / "cloud.ply", cloud)
    written = [("cloud PLY", folder / "cloud.ply", cloud.points)]
    frames = []
    for frame, points in split_frames(cloud):
        frames.append(folder / frame_name(frame))
        save_cloud(frames[-1], points)
    save_project(folder / "frames.mlp", frames)
    written.append(("MLP", folder / "frames.mlp", cloud.points))
    for suffix in ("ply", "stl", "glb"):
        path = folder / f"mesh.{suffix}"
        save_mesh(path, mesh)
        written.append((f"mesh {suffix.upper()}", path, mesh.vertices))
    return written


def main() -> None:
    cloud = make_cloud()
    mesh = GridMesh().mesh(cloud)
    figures = []
    with tempfile.TemporaryDirectory() as folder:
        for name, path, vertices in write_all(Path(folder), cloud, mesh):
            faces = len(mesh.faces) if path.stem == "mesh" else 0
            figures += compare(f"{name}, MeshLab", path, vertices, faces, read_by_meshlab)
            if path.suffix != ".mlp":
                figures += compare(f"{name}, trimesh", path, vertices, faces, read_by_trimesh)
        opened = pymeshlab.MeshSet(verbose=False)
        opened.load_new_mesh(f"{folder}/cloud.ply")
        normals = opened.current_mesh().vertex_normal_matrix()
    wrong = int(np.sum(np.abs(normals - cloud.normals).max(axis=1) > 1e-6))
    figures.append(Figure("cloud PLY, MeshLab: normals lost", wrong, at_most=0))
    tell("formats", "Formats, opened by others", figures, note=NOTE)


if __name__ == "__main__":
    main()
