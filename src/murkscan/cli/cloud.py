"""murkscan cloud: merge the profiles."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from .progress import progress_bars


def cloud(out: Path, *, frames: Annotated[bool, Parameter(negative=())] = False) -> None:
    """Merge the profiles of a scan into one cloud of points.

    Parameters
    ----------
    out
        Folder of the scan, with finished triangulate and motion stages.
    frames
        Write one cloud a frame for more than 500 frames, too.
    """
    from ..project import Project
    from ..survey.cloud import build_cloud
    from ..survey.scan_rig import load_scan_rig
    from .summary import print_result

    project = Project(out)
    with progress_bars() as progress:
        result = build_cloud(project, load_scan_rig(project), frames=frames, progress=progress)
    print_result("cloud", result, out / "cloud")
