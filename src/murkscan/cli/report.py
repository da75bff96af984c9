"""murkscan report: a page on how the scan went."""

from .paths import ScanFolder
from .progress import progress_bars
from .typed import WORDS


def report(
    out: ScanFolder,
    *,
    spacing_mm: float | None = None,
    title: str = "",
    client: str = "",
    place: str = "",
) -> None:
    """Write a page on how the scan went: coverage, spacing, signal, uncertainty, settings.

    Parameters
    ----------
    out
        Folder of the scan, with all stages up to view finished.
    spacing_mm
        Wanted spacing of the points, by which gaps and the speed are judged; gaps by the scan's own
        unless given.
    title
        What the page is called.
    client
        For whom the scan was made.
    place
        Where, such as the ship or the pier.
    """
    from ..project import Project
    from ..report import Heading
    from ..survey.report import write_report
    from .summary import print_result

    with progress_bars() as progress:
        spacing = None if spacing_mm is None else spacing_mm / 1e3
        result = write_report(
            Project(out, WORDS.get()),
            spacing=spacing,
            heading=Heading(title, client, place),
            progress=progress,
        )
    print_result("report", result, out / "report" / "index.html", out=out)
