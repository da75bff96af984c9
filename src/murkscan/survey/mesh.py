"""Make a surface from a scan's cloud."""

from collections.abc import Iterable, Iterator
from contextlib import closing
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from ..distribute import AbstractExecutor, Threads
from ..io.mesh_files import check_mesh_suffix, file_origin, save_mesh
from ..mesh import (
    AbstractMesher,
    AbstractPaint,
    ByDepth,
    close_holes,
    decimate,
    join_sheets,
    join_tiles,
    split_by_laser,
)
from ..project import (
    CLOUD,
    EXTRACT,
    MESH,
    MeshResult,
    Project,
    describe,
    find_trajectory,
    is_merged,
    load_georeference,
)
from ..project.blocks import BLOCK, Block, cut_blocks, trim_beside
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
    block: int = BLOCK,
    executor: AbstractExecutor | None = None,
    progress: Progress = silent,
) -> MeshResult:
    """Run the mesh stage.

    Args:
        project: A scan with a finished cloud stage.
        mesher: The way to make a surface.
        finish: What is done to it afterwards; it is coloured by depth unless given.
        block: Points of a tile, about; the result depends on it.
        executor: Who makes tiles; threads unless given. The result is the same.
        progress: Told how many tiles are done.

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
        painted = replace(asked, paint=_towards(asked.paint, project))
        mesh = _make_surface(project, mesher, block, executor or Threads(), progress)
        return _finish(mesh, project, painted)

    def make(made: tuple[Mesh, MeshResult]) -> MeshResult:
        mesh, result = made
        if result.faces:
            project.save_mesh(mesh)
        return result

    result = run_stage(project, stage, make, prepare=prepare, progress=progress)
    record = project.load_scan()
    if record.origin != result.origin:
        with project.hold():
            project.save_scan(replace(record, origin=result.origin))
    return result


def export_mesh(project: Project, path: Path) -> int:
    """Write a finished surface to another file, and count its triangles.

    Where the scan is georeferenced, the file lies in its coordinate system.

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
    mesh, place = project.load_mesh(), load_georeference(project)
    if place is not None:
        mesh = replace(mesh, vertices=place.place(mesh.vertices))
    save_mesh(path, mesh)
    return len(mesh.faces)


def check_mesh_export(path: Path) -> None:
    """Refuse now what `export_mesh` would refuse after other work.

    Raises:
        InputError: The suffix is no mesh's, or the file lies among what a stage has made.
    """
    check_mesh_suffix(path)
    require_outside_stages(path)


def _make_surface(
    project: Project,
    mesher: AbstractMesher,
    block: int,
    executor: AbstractExecutor,
    progress: Progress,
) -> Mesh:
    """Make the surface in tiles where that can be, else as a whole."""
    if is_merged(project):
        return _join_passes(project, mesher)
    if not mesher.works_in_tiles:
        return mesher.mesh(project.load_cloud())
    blocks, job = cut_blocks(project.count_cloud_points(), block=block), _TileJob(project, mesher)

    def tell(tiles: Iterable[Mesh]) -> Iterator[Mesh]:
        for done, tile in enumerate(tiles, 1):
            progress("mesh", done, len(blocks))
            yield tile

    with closing(executor.map(job.make, blocks)) as tiles:
        mesh = join_tiles(tell(tiles))
    if len(project.finished(EXTRACT).result.lasers) == 1:
        return mesh
    laser = np.concatenate([part.laser for part in project.iterate_cloud()])
    return join_sheets(split_by_laser(mesh, laser))


def _join_passes(project: Project, mesher: AbstractMesher) -> Mesh:
    """Make one surface of the passes of a merged cloud."""
    cloud, merged = project.load_cloud(), project.finished(CLOUD).result
    owner = merged.number_passes(cloud.frame)
    rows = [np.flatnonzero(owner == number) for number in range(len(merged.passes))]
    mesh = mesher.mesh_passes([cloud[some] for some in rows if len(some)])
    return replace(mesh, points=np.concatenate(rows)[mesh.points])


@dataclass(frozen=True, eq=False)
class _TileJob:
    """What every tile needs, wherever it is made."""

    project: Project
    mesher: AbstractMesher

    def make(self, block: Block) -> Mesh:
        """Make the tile of a block's points."""
        before, own, after = (
            PointCloud.concatenate([self.project.load_kept_part(number) for number in numbers])
            for numbers in (block.before, block.parts, block.after)
        )
        before, after = trim_beside(before, after)
        cloud, start = PointCloud.concatenate([before, own, after]), len(before)
        return self.mesher.mesh_tile(cloud, slice(start, start + len(own)))


def _finish(mesh: Mesh, project: Project, finish: Finish) -> tuple[Mesh, MeshResult]:
    closed = left = None
    if finish.largest_hole is not None:
        filled = close_holes(mesh, largest=finish.largest_hole)
        mesh, closed, left = filled.mesh, filled.num_closed, filled.num_left
    if finish.faces is not None:
        mesh = decimate(mesh, faces=finish.faces)
    if finish.paint is not None and len(mesh.faces):
        column = finish.paint.column
        signal = np.concatenate([getattr(part, column) for part in project.iterate_cloud()])
        mesh = replace(mesh, colours=finish.paint.paint(mesh, signal))
    return mesh, MeshResult(
        vertices=len(mesh.vertices),
        faces=len(mesh.faces),
        holes_closed=closed,
        holes_left=left,
        faces_filled=None if mesh.filled is None else int(mesh.filled.sum()),
        origin=tuple(file_origin(Path("mesh.stl"), mesh).tolist()),
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
