"""Make a surface from a scan's cloud."""

import time
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from ..io.mesh_files import check_mesh_suffix, save_mesh
from ..mesh import AbstractMesher, AbstractPaint, ByDepth, close_holes, decimate
from ..project import Project
from ..types.cloud import PointCloud
from ..types.mesh import Mesh
from .export import require_outside_stages
from .merged import load_way, split_passes
from .progress import Progress, silent
from .settings import describe


@dataclass(frozen=True)
class Finish:
    """What is done to a surface when it has been made."""

    largest_hole: float | None = None
    """Width up to which holes are closed [m]; None: all stay open."""
    faces: int | None = None
    """Triangles that are left, about; None: all."""
    paint: AbstractPaint | None = field(default_factory=ByDepth)
    """Its colours; depth is counted in the direction in which the camera looked. None: none."""


def build_mesh(
    project: Project,
    mesher: AbstractMesher,
    *,
    finish: Finish | None = None,
    progress: Progress = silent,
) -> dict[str, Any]:
    """Run the mesh stage.

    Args:
        project: A scan with a finished cloud stage.
        mesher: The way to make a surface.
        finish: What is done to it afterwards; it is coloured by depth unless given.
        progress: Told when it begins and when it is done.

    Returns:
        Counts: vertices and faces; both 0 for a cloud that has no two neighbouring profiles. Where
        holes were to be closed, how many were and were not, and how many faces close them.

    Raises:
        MissingResult: The cloud stage has not been finished.
        InputError: What is asked for afterwards makes no sense.
        MissingDependency: The mesher needs an extra that is not installed.
        DeviceError: The disk is full.
    """
    finish = finish or Finish()
    stage = project.stage(
        "mesh",
        settings={"mesher": describe(mesher), "finish": describe(finish)},
        inputs={"cloud": project.finished("cloud").digest},
    )
    if (result := stage.result()) is not None:
        return result
    since = time.monotonic()
    progress("mesh", 0, None)
    cloud = project.load_cloud()
    finish = replace(finish, paint=_towards(finish.paint, project))
    mesh, holes = _finish(mesher.mesh_passes(split_passes(project, cloud)), cloud, finish)
    stage.begin()
    if len(mesh.faces):
        project.save_mesh(mesh)
    result = {"vertices": len(mesh.vertices), "faces": len(mesh.faces), **holes}
    stage.finish(result, since=since)
    progress("mesh", 1, 1)
    return result


def export_mesh(project: Project, path: Path) -> int:
    """Write a finished surface to another file, and count its triangles.

    Args:
        project: A scan with a finished mesh stage.
        path: The file; its suffix is one of .ply, .stl, .obj and .glb.

    Raises:
        MissingResult: The mesh stage has not been finished.
        InputError: The suffix is another, the file lies among what a stage has made, or there is
            no surface.
        DeviceError: The disk is full or cannot be written.
    """
    check_mesh_export(path)
    mesh = project.load_mesh()
    save_mesh(path, mesh)
    return len(mesh.faces)


def check_mesh_export(path: Path) -> None:
    """Refuse now what `export_mesh` would refuse after other work.

    Raises:
        InputError: The suffix is no mesh's, or the file lies among what a stage has made.
    """
    check_mesh_suffix(path)
    require_outside_stages(path)


def _finish(mesh: Mesh, cloud: PointCloud, finish: Finish) -> tuple[Mesh, dict[str, int]]:
    counts: dict[str, int] = {}
    if finish.largest_hole is not None:
        closed = close_holes(mesh, largest=finish.largest_hole)
        mesh, counts = (
            closed.mesh,
            {"holes_closed": closed.num_closed, "holes_left": closed.num_left},
        )
    if finish.faces is not None:
        mesh = decimate(mesh, faces=finish.faces)
    if mesh.filled is not None:
        counts["faces_filled"] = int(mesh.filled.sum())
    if finish.paint is not None and len(mesh.faces):
        mesh = replace(mesh, colours=finish.paint.paint(mesh, cloud))
    return mesh, counts


def _towards(paint: AbstractPaint | None, project: Project) -> AbstractPaint | None:
    """Count depth in the mean direction in which the camera looked, where that is known."""
    if not isinstance(paint, ByDepth):
        return paint
    way = load_way(project)
    if way is None:
        return paint
    attitudes = Rotation.from_quat(way.quaternions, scalar_first=True)
    x, y, z = (float(part) for part in attitudes.mean().apply(np.array([0.0, 0.0, 1.0])))
    return ByDepth((x, y, z))
