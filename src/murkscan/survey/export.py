"""Write a scan's cloud in another format, in streams."""

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..cloud import thin_clouds
from ..distribute import AbstractExecutor, Threads
from ..errors import InputError, MissingResult
from ..io.cloud_files import check_cloud_suffix, writing_cloud_file
from ..project import (
    ACCEPT,
    CLOUD,
    GEOREFERENCE,
    MEASURE,
    STAGES,
    Project,
    find_trajectory,
    load_georeference,
)
from ..types.cloud import PointCloud
from .progress import Progress, silent

_FOLDERS = tuple(kind.word for kind in (*STAGES, GEOREFERENCE, MEASURE, ACCEPT))
"""Folders in which only stages write."""
_SIGHT = 100.0
"""Distance to which no camera sees a laser's line under water [m]."""


def export_cloud(
    project: Project,
    path: Path,
    *,
    voxel: float | None = None,
    executor: AbstractExecutor | None = None,
    progress: Progress = silent,
) -> int:
    """Write the cloud of a scan to a file, with bounded memory.

    Where the scan is georeferenced, the file lies in its coordinate system, and names it if it can.

    Args:
        project: A scan with a finished cloud stage.
        path: The file; its suffix is one of .ply, .las, .laz, .e57, .xyz and .csv.
        voxel: Edge of the voxels to thin to [m]; None writes all points.
        executor: Who reads and checks the cloud's parts; threads unless given. The file is the
            same.
        progress: Told how many points are written.

    Returns:
        The number of points written.

    Raises:
        MissingResult: The cloud stage has not been finished, or made anew since `georeference`.
        InputError: The suffix is no cloud's, the cloud is empty, or the file lies among what a
            stage has made.
        DeviceError: The disk is full.
    """
    count = project.finished(CLOUD).result.points
    check_export(path)
    if count == 0:
        raise InputError(f"The cloud of {project.root} has no points; there is nothing to export.")
    blocks, place = _Blocks(project, executor or Threads()), load_georeference(project)
    written = 0
    wkt, extent = "" if place is None else place.wkt, _find_extent(project, blocks)
    with writing_cloud_file(path, wkt=wkt, extent=extent) as write:
        for block in blocks if voxel is None else thin_clouds(blocks, voxel):
            write(block if place is None else place.carry(block))
            written += len(block)
            progress("export", written, count if voxel is None else None)
    progress("export", written, written)
    return written


def _find_extent(project: Project, blocks: "_Blocks") -> float:
    """Give an upper limit of a cloud's longest edge [m]."""
    with suppress(MissingResult):  # a cloud may be there alone; then its own points tell
        trajectory = find_trajectory(project)
        if trajectory is not None:
            return float(np.linalg.norm(np.ptp(trajectory.positions, axis=0))) + 2 * _SIGHT
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for block in blocks:
        low = np.minimum(low, block.points.min(axis=0, initial=np.inf))
        high = np.maximum(high, block.points.max(axis=0, initial=-np.inf))
    return float(np.linalg.norm(high - low))  # a place on the Earth may turn it


def check_export(path: Path) -> None:
    """Refuse now what `export_cloud` would refuse after an hour of other work.

    Raises:
        InputError: The suffix is no cloud's, or the file lies among what a stage has made.
    """
    check_cloud_suffix(path)
    require_outside_stages(path)


def require_outside_stages(path: Path) -> None:
    """Refuse to write over what the stages of any scan have made.

    Raises:
        InputError: The file lies in a stage's folder.
    """
    path = path.resolve()
    for root in path.parents:
        stage = path.relative_to(root).parts[0]
        if stage in _FOLDERS and (root / "scan.json").exists():
            raise InputError(
                f"{path} lies among the files of the {stage} stage; export to another folder."
            )


@dataclass(frozen=True)
class _Blocks:
    """The blocks of a scan's cloud; they can be gone through again."""

    project: Project
    executor: AbstractExecutor

    def __iter__(self) -> Iterator[PointCloud]:
        return self.executor.map(self.project.load_kept_part, self.project.find_cloud_parts())
