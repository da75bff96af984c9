"""Make a surface from a scan's cloud."""

from dataclasses import dataclass, field, replace
from pathlib import Path

from ..io.mesh_files import check_mesh_suffix, save_mesh
from ..mesh import AbstractMesher, AbstractPaint, ByDepth, close_holes, decimate
from ..project import CLOUD, MESH, MeshResult, Project, describe, find_trajectory, is_merged
from ..types.cloud import PointCloud
from ..types.mesh import Mesh
from .export import require_outside_stages
from .progress import Progress, silent
from .stage_runner import run_stage


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
) -> MeshResult:
    """Run the mesh stage.

    Args:
        project: A scan with a finished cloud stage.
        mesher: The way to make a surface.
        finish: What is done to it afterwards; it is coloured by depth unless given.
        progress: Told when it begins and when it is done.

    Returns:
        No vertices and faces for a cloud that has no two neighbouring profiles.

    Raises:
        MissingResult: The cloud stage has not been finished.
        InputError: What is asked for afterwards makes no sense.
        MissingDependency: The mesher needs an extra that is not installed.
        DeviceError: The disk is full.
    """
    asked = finish or Finish()
    stage = project.stage(
        MESH,
        settings={"mesher": describe(mesher), "finish": describe(asked)},
        inputs={"cloud": project.finished(CLOUD).digest},
    )

    def prepare() -> tuple[Mesh, MeshResult]:
        cloud = project.load_cloud()
        painted = replace(asked, paint=_towards(asked.paint, project))
        return _finish(mesher.mesh_passes(_split(project, cloud)), cloud, painted)

    def make(made: tuple[Mesh, MeshResult]) -> MeshResult:
        mesh, result = made
        if result.faces:
            project.save_mesh(mesh)
        return result

    return run_stage(project, stage, make, prepare=prepare, progress=progress)


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


def _split(project: Project, cloud: PointCloud) -> list[PointCloud]:
    """Give the points of each pass of a merged cloud, those without any left out; else all."""
    if not is_merged(project):
        return [cloud]
    merged = project.finished(CLOUD).result
    owner = merged.number_passes(cloud.frame)
    parts = [cloud[owner == number] for number in range(len(merged.passes))]
    return [part for part in parts if len(part)]


def _finish(mesh: Mesh, cloud: PointCloud, finish: Finish) -> tuple[Mesh, MeshResult]:
    closed = left = None
    if finish.largest_hole is not None:
        filled = close_holes(mesh, largest=finish.largest_hole)
        mesh, closed, left = filled.mesh, filled.num_closed, filled.num_left
    if finish.faces is not None:
        mesh = decimate(mesh, faces=finish.faces)
    if finish.paint is not None and len(mesh.faces):
        mesh = replace(mesh, colours=finish.paint.paint(mesh, cloud))
    return mesh, MeshResult(
        vertices=len(mesh.vertices),
        faces=len(mesh.faces),
        holes_closed=closed,
        holes_left=left,
        faces_filled=None if mesh.filled is None else int(mesh.filled.sum()),
    )


def _towards(paint: AbstractPaint | None, project: Project) -> AbstractPaint | None:
    """Count depth in the mean direction in which the camera looked, where that is known."""
    if not isinstance(paint, ByDepth):
        return paint
    trajectory = find_trajectory(project)
    if trajectory is None:
        return paint
    x, y, z = trajectory.line_of_sight().tolist()
    return ByDepth((x, y, z))
