"""murkscan cloud: merge the profiles, and write the cloud in other formats."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from ..errors import InputError
from ..ui.choices import make_rules
from .options import Attenuation, ExecutorFlags, MaybePlace
from .paths import ScanFolder
from .progress import progress_bars
from .typed import WORDS


def cloud(
    out: ScanFolder,
    *,
    export: Annotated[tuple[Path, ...], Parameter(negative=())] = (),
    voxel_mm: float | None = None,
    min_posterior: float = 0.5,
    volume_m: MaybePlace = None,
    attenuation_per_m: Attenuation = None,
    frames: Annotated[bool, Parameter(negative=())] = False,
    work: ExecutorFlags = ExecutorFlags(),
) -> None:
    """Merge the profiles of a scan into one cloud of points.

    A cloud that `murkscan merge` has made is not made again, only exported.

    Parameters
    ----------
    out
        Folder of the scan, with finished triangulate and motion stages.
    export
        Write the cloud to this file, too: .ply, .las, .laz, .copc.laz, .e57, .xyz or
        .csv; may be given again.
    voxel_mm
        Thin what is exported to one point a voxel of this edge [mm]: means, weighted by sigma.
    min_posterior
        Take out points less probable than this to be the surface.
    volume_m
        Leave out what lies outside of this box: two corners X,Y,Z,X,Y,Z in the world [m].
    frames
        Write one cloud a frame for more than 500 frames, too.
    """
    if voxel_mm is not None and not export:
        raise InputError("--voxel-mm thins what is exported; say where to with --export FILE.")
    if voxel_mm is not None and not 0 < voxel_mm < float("inf"):
        raise InputError(f"--voxel-mm must be above 0, got {voxel_mm:g}.")
    executor = work.make()
    from ..project import CLOUD, Project, is_merged, load_scan_rig
    from ..survey.cloud import build_cloud
    from ..survey.export import check_export, export_cloud
    from .summary import print_result
    from .words import tell

    project, rules = Project(out, WORDS.get()), make_rules(volume_m, min_posterior=min_posterior)
    for path in export:
        check_export(path)
    with progress_bars() as progress:
        if is_merged(project):
            result = project.finished(CLOUD).result
        else:
            rig = load_scan_rig(project)
            result = build_cloud(
                project, rig, rules=rules, attenuation=attenuation_per_m, frames=frames,
                executor=executor, progress=progress,
            )  # fmt: skip
        voxel = None if voxel_mm is None else voxel_mm / 1e3
        written = [
            export_cloud(project, path, voxel=voxel, executor=executor, progress=progress)
            for path in export
        ]
    for path, count in zip(export, written, strict=True):
        tell("exported", f"{count:,} points: {path}")
    print_result("cloud", result, out / "cloud" / "cloud.ply", out=out)
