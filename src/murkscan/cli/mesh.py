"""murkscan mesh: make a surface."""

from pathlib import Path

from .choices import MesherName, make_mesher
from .options import Settings
from .progress import progress_bars


def mesh(
    out: Path,
    *,
    mesher: MesherName = "grid",
    settings: Settings = (),
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
    """
    from ..project import Project
    from ..survey.mesh import build_mesh
    from .summary import print_result

    with progress_bars() as progress:
        result = build_mesh(Project(out), make_mesher(mesher, settings), progress=progress)
    print_result("mesh", result, out / "mesh")
