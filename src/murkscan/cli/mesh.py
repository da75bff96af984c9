"""murkscan mesh: make a surface."""

from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

from ..errors import InputError
from ..ui.choices import MesherName, check_settings, make_mesher
from .options import ExecutorFlags, Settings
from .paths import ScanFolder
from .progress import progress_bars
from .typed import WORDS


def mesh(
    out: ScanFolder,
    *,
    mesher: MesherName = "grid",
    settings: Settings = (),
    close_holes_mm: float | None = None,
    faces: int | None = None,
    colour: Literal["depth", "signal", "reflectance", "none"] = "depth",
    export: Annotated[tuple[Path, ...], Parameter(negative=())] = (),
    work: ExecutorFlags = ExecutorFlags(),
) -> None:
    """Make a surface from the cloud of a scan.

    Parameters
    ----------
    out
        Folder of the scan, with a finished cloud stage.
    mesher
        The way to make a surface.
    settings
        A setting of the mesher, as NAME=NUMBER; may be given again.
    close_holes_mm
        Close holes up to this width [mm]. In mesh.ply their triangles are marked as filled.
    faces
        Leave about so many triangles: few where the surface is flat, more where it is curved.
    colour
        Colour the vertices by depth, by the stripe's brightness, or by its reflectance: what its
        brightness would be without distance, water and slope.
    export
        Write the surface to this file, too: .ply, .stl, .obj or .glb; may be given again.
    """
    if close_holes_mm is not None and not 0 < close_holes_mm < float("inf"):
        raise InputError(f"--close-holes-mm must be above 0, got {close_holes_mm:g}.")
    if faces is not None and faces < 4:
        raise InputError(f"--faces must be 4 or more, got {faces}.")
    check_settings(settings)
    executor = work.make()
    from ..mesh import ByDepth, ByReflectance, BySignal
    from ..project import Project
    from ..survey.mesh import Finish, build_mesh, check_mesh_export, export_mesh
    from .summary import print_result
    from .words import tell

    for path in export:
        check_mesh_export(path)
    paints = {
        "depth": ByDepth(), "signal": BySignal(), "reflectance": ByReflectance(), "none": None
    }  # fmt: skip
    finish = Finish(
        largest_hole=None if close_holes_mm is None else close_holes_mm / 1e3,
        faces=faces,
        paint=paints[colour],
    )
    chosen = make_mesher(mesher, settings)
    project = Project(out, WORDS.get())
    with progress_bars() as progress:
        result = build_mesh(project, chosen, finish=finish, executor=executor, progress=progress)
        written = [export_mesh(project, path) for path in export]
    for path, count in zip(export, written, strict=True):
        tell("exported", f"{count:,} triangles: {path}")
    print_result("mesh", result, out / "mesh", out=out)
