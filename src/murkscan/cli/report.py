"""murkscan report: a page on how the scan went."""

from pathlib import Path

from .progress import progress_bars


def report(out: Path) -> None:
    """Write a page on how the scan went: settings, counts, signal, spacing, pictures.

    Parameters
    ----------
    out
        Folder of the scan, with all stages up to view finished.
    """
    from ..project import Project
    from ..survey.report import write_report
    from .summary import print_result

    with progress_bars() as progress:
        write_report(Project(out), progress=progress)
    print_result("report", {}, out / "report" / "index.html")
