"""murkscan view: pictures of the surface, and the page with the model."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from ..errors import InputError
from .paths import ScanFolder, require_scan
from .progress import progress_bars
from .typed import WORDS

Flag = Annotated[bool, Parameter(negative=())]


def view(
    out: ScanFolder,
    *,
    other: Annotated[Path | None, Parameter(name="--with", validator=require_scan)] = None,
    as_given: Flag = False,
    deviation: str = "deviation",
    points: int = 2_000_000,
    title: str | None = None,
    film: Path | None = None,
) -> None:
    """Draw a scan's surface from seven sides, and write a page to turn, cut and measure it.

    Parameters
    ----------
    out
        Folder of the scan, with a finished mesh stage.
    other
        Folder of another scan, to change to on the page: before and after.
    as_given
        Take the other scan where its poses put it; otherwise it is laid on this one by ICP, and the
        page says how far it was moved.
    deviation
        Name of the measurement in OUT/measure by whose deviations the page is coloured, if there is
        one.
    points
        Points, and vertices of the surface, that the page holds of a scan; of more it shows a fair
        choice.
    title
        What stands above the page; the recording's name unless given.
    film
        Write a film of the surface turned once round to this file, too: .mp4.
    """
    if film is not None and film.suffix.lower() != ".mp4":
        raise InputError(f"--film writes .mp4, not {film.name}.")
    with progress_bars() as progress:
        from ..project import Project
        from ..survey.view import draw_views, film_scan
        from .summary import print_result
        from .words import tell

        result = draw_views(
            Project(out, WORDS.get()),
            other=None if other is None else Project(other),
            align=not as_given,
            deviation=deviation,
            most=points,
            title=title,
            progress=progress,
        )
        if film is not None:
            film_scan(Project(out), film, progress=progress)
    if film is not None:
        tell("film", str(film))
    print_result("view", result, out / "view" / "index.html", out=out)
