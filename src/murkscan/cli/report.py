"""murkscan report: a page on how the scan went."""

from pathlib import Path


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

    write_report(Project(out))
    print_result("report", {}, out / "report" / "index.html")
