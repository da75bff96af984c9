"""Show a scan's surface: pictures for print, and a page on which it is turned and measured."""

import time
from typing import Any

from ..errors import InputError
from ..page import Gallery, Note, Picture, Section, render_page
from ..project import Project
from ..types.mesh import Mesh
from ..view import MOST, PICTURES, draw_pictures, render_viewer
from .compared import Compared, compare_models
from .merged import load_way
from .progress import Progress, silent
from .shown import DEVIATION, deviation_digest, has_surface, load_model, title_of


def draw_views(
    project: Project,
    *,
    other: Project | None = None,
    align: bool = True,
    deviation: str = DEVIATION,
    most: int = MOST,
    progress: Progress = silent,
) -> dict[str, Any]:
    """Run the view stage: nine pictures, the page that shows them, and the page with the model.

    Args:
        project: A scan, or a merged cloud, with a finished mesh stage.
        other: Another one, to change to on the page: before and after.
        align: Whether the other one is laid on the scan by ICP; otherwise it stays where its poses
            put it.
        deviation: Name of the measurement whose deviations the page shows, if it has been made.
        most: Points, and vertices of the surface, that the page holds of a scan.
        progress: Told how many pictures are drawn.

    Returns:
        The names of the pictures, in the order to show them, none for a scan without a surface;
        how many points the page shows; of two scans in words how the other one was moved, and the
        same in numbers.

    Raises:
        MissingResult: The mesh stage has not been finished.
        Degenerate: The scans do not overlap.
        InputError: There are to be no points on the page, or a deviation has not been measured.
        DeviceError: The disk is full.
    """
    if most < 1:
        raise InputError(f"The page must hold one point or more, got {most}.")
    inputs = {"mesh": project.finished("mesh").digest}
    if (digest := deviation_digest(project, deviation)) is not None:
        inputs["deviation"] = digest
    if other is not None:
        inputs["other"] = f"{other.root} {other.finished('mesh').digest}"
    settings = {"most": most, "align": align and other is not None}
    stage = project.stage("view", settings=settings, inputs=inputs)
    if (result := stage.result()) is not None:
        return result
    since = time.monotonic()
    # Pictures and page of before stay until all that the new ones need has been read.
    surface = project.load_mesh() if has_surface(project) else None
    shown = _load(project, other, align=align, deviation=deviation, most=most)
    stage.begin()
    names = [] if surface is None else _draw(project, surface, progress)
    title = title_of(project)
    project.save_pictures_page(_pictures_page(title, names))
    project.save_view_page(_page(title, shown))
    result = {
        "pictures": names,
        "points": sum(model.num_measured for model in shown.models),
        "relation": shown.relation,
        "alignment": shown.alignment,
    }
    stage.finish(result, since=since)
    return result


def _load(
    project: Project, other: Project | None, *, align: bool, deviation: str, most: int
) -> Compared:
    """Load what there is to show."""
    if other is not None:
        return compare_models(project, other, align=align, deviation=deviation, most=most)
    model = load_model(project, most=most, deviation=deviation)
    return Compared([] if model is None else [model], "", None)


def _page(title: str, shown: Compared) -> str:
    if not shown.models:
        return _empty(title)
    return render_viewer(
        shown.models, title=title, pictures="pictures.html", relation=shown.relation
    )


def _draw(project: Project, surface: Mesh, progress: Progress) -> list[str]:
    names: list[str] = []
    progress("view", 0, len(PICTURES))
    for name, picture in draw_pictures(surface, load_way(project)):
        project.save_picture(name, picture)
        names.append(name)
        progress("view", len(names), len(PICTURES))
    return names


def _pictures_page(title: str, names: list[str]) -> str:
    """Show the pictures side by side."""
    if not names:
        note = Note("There is no surface to draw: no stripe was found in two frames or more.")
        return render_page("Pictures", [Section("", [note])], subtitle=title)
    pictures = [Picture(f"{name}.png", name.replace("-", ", coloured by ")) for name in names]
    gallery = Gallery(pictures, is_first_large=True)
    return render_page("Pictures", [Section("", [gallery])], subtitle=title)


def _empty(title: str) -> str:
    note = Note("There is nothing to show: no point was found. Look at extract/overlay.", "warning")
    return render_page("Model", [Section("", [note])], subtitle=title)
