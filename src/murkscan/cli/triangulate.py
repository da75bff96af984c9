"""murkscan triangulate: turn stripes into profiles."""

from ..ui.choices import MethodName, make_method
from .options import ExecutorFlags
from .paths import ScanFolder
from .progress import progress_bars
from .typed import WORDS


def triangulate(
    out: ScanFolder,
    *,
    method: MethodName = "ray-sheet",
    work: ExecutorFlags = ExecutorFlags(),
) -> None:
    """Turn the stripes of a scan into profiles in the camera's frame.

    Parameters
    ----------
    out
        Folder of the scan, with a finished extract stage.
    method
        The way from pixels to points.
    """
    executor = work.make()
    from ..project import Project, load_scan_rig
    from ..survey.triangulate import triangulate_stripes
    from .summary import print_result

    project = Project(out, WORDS.get())
    with progress_bars() as progress:
        result = triangulate_stripes(
            project,
            load_scan_rig(project),
            make_method(method),
            executor=executor,
            progress=progress,
        )
    print_result("triangulate", result, out / "triangulate", out=out)
