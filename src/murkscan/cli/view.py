"""murkscan view: draw pictures of the surface."""

from pathlib import Path

from .progress import progress_bars


def view(out: Path) -> None:
    """Draw pictures of the surface of a scan, isometric and from six sides.

    Parameters
    ----------
    out
        Folder of the scan, with a finished mesh stage.
    """
    from ..project import Project
    from ..survey.view import draw_views
    from .summary import print_result

    with progress_bars() as progress:
        result = draw_views(Project(out), progress=progress)
    print_result("view", {"pictures": len(result["pictures"])}, out / "view")
