"""How long the nine pictures of a scan take, against casting one ray a sample on Embree."""

import tempfile
from pathlib import Path

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene
from harness import Figure, best_time, tell

from murkscan.io.images import write_image
from murkscan.types.mesh import Mesh
from murkscan.view import draw_pictures

COLUMNS, ROWS = 950, 500
SIZE = (1280, 960)
SAMPLES = 2


def scanned_surface() -> Mesh:
    """Make a wavy plate with a dent and noise, 475 000 points in profiles."""
    x, y = np.meshgrid(np.linspace(0, 2, COLUMNS), np.linspace(-0.5, 0.5, ROWS), indexing="ij")
    noise = np.random.default_rng(0).normal(0, 5e-4, x.shape)
    dent = 0.03 * ((x - 1) ** 2 + y**2 < 0.04)
    z = 1 + 0.2 * np.cos(3 * y) + 0.05 * np.sin(8 * x) + dent + noise
    number = np.arange(x.size).reshape(x.shape)
    a, b = number[:-1, :-1].ravel(), number[1:, :-1].ravel()
    c, d = number[1:, 1:].ravel(), number[:-1, 1:].ravel()
    faces = np.concatenate([np.stack([a, c, b], axis=1), np.stack([a, d, c], axis=1)])
    return Mesh(np.stack([x, y, z], axis=2).reshape(-1, 3), faces)


def cast_rays(mesh: Mesh) -> None:
    """Cast one ray through each sample of one picture, as pictures were drawn before."""
    scene = EmbreeScene()
    TriangleMesh(scene, mesh.vertices.astype(np.float32), mesh.faces.astype(np.int32))
    width, height = SIZE[0] * SAMPLES, SIZE[1] * SAMPLES
    x, y = np.meshgrid(np.linspace(0, 2, width), np.linspace(-0.5, 0.5, height))
    origins = np.stack([x.ravel(), y.ravel(), np.full(x.size, -1.0)], axis=1).astype(np.float32)
    away = np.zeros_like(origins)
    away[:, 2] = 1
    scene.run(origins, away, output=True)


def main() -> None:
    mesh = scanned_surface()
    with tempfile.TemporaryDirectory() as folder:

        def draw() -> None:
            for name, picture in draw_pictures(mesh, size=SIZE):
                write_image(Path(folder) / f"{name}.png", picture)

        draw()  # compiles the loops
        ours = best_time(draw, repeats=3)
    rays = 9 * best_time(lambda: cast_rays(mesh), repeats=2)
    figures = [
        Figure("nine pictures, drawn and written", ours, "s", at_most=3.0),
        Figure("casting the rays of nine pictures on Embree", rays, "s"),
        Figure("rays / pictures", rays / ours, ": 1", at_least=1.0),
    ]
    note = (
        f"{len(mesh.vertices):,} points, {len(mesh.faces):,} triangles, {SIZE[0]} × {SIZE[1]} px, "
        "four samples a pixel, two threads. Embree (one thread) finds only what is seen: no light, "
        "no colours, no writing."
    )
    tell("pictures", "Nine pictures of a scan", figures, note=note)


if __name__ == "__main__":
    main()
