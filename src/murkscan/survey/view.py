"""Show a scan's surface: pictures for print, and a page on which it is turned and measured."""

import time
from dataclasses import replace
from typing import Any

from ..errors import InputError
from ..page import Gallery, Note, Picture, Section, render_page
from ..project import Project
from ..view import MOST, PICTURES, Model, draw_pictures, render_viewer
from .merged import is_merged
from .progress import Progress, silent
from .shown import DEVIATION, deviation_digest, folder_of, load_model, title_of


def draw_views(
    project: Project,
    *,
    other: Project | None = None,
    deviation: str = DEVIATION,
    most: int = MOST,
    progress: Progress = silent,
) -> dict[str, Any]:
    """Run the view stage: nine pictures, the page that shows them, and the page with the model.

    Args:
        project: A scan, or a merged cloud, with a finished mesh stage.
        other: Another one, in the same world, to change to on the page: before and after.
        deviation: Name of the measurement whose deviations the page shows, if it has been made.
        most: Points, and vertices of the surface, that the page holds of a scan.
        progress: Told how many pictures are drawn.

    Returns:
        The names of the pictures, in the order to show them, none for a scan without a surface;
        and how many points the page shows.

    Raises:
        MissingResult: The mesh stage has not been finished.
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
    stage = project.stage("view", settings={"most": most}, inputs=inputs)
    if (result := stage.result()) is not None:
        return result
    since = time.monotonic()
    stage.begin()
    names = _draw(project, progress)
    title = title_of(project)
    project.save_pictures_page(_pictures_page(title, names))
    models = _load_models(project, other, deviation=deviation, most=most)
    page = render_viewer(models, title=title, pictures="pictures.html") if models else _empty(title)
    project.save_view_page(page)
    result = {"pictures": names, "points": sum(model.num_measured for model in models)}
    stage.finish(result, since=since)
    return result


def _load_models(
    project: Project, other: Project | None, *, deviation: str, most: int
) -> list[Model]:
    """Load what there is to show; two scans are named by their folders."""
    shown = load_model(project, most=most, deviation=deviation)
    if other is None:
        return [] if shown is None else [shown]
    both = (shown, project), (load_model(other, most=most), other)
    return [replace(model, name=folder_of(scan)) for model, scan in both if model is not None]


def _draw(project: Project, progress: Progress) -> list[str]:
    names: list[str] = []
    if project.finished("mesh").counts()["faces"]:
        progress("view", 0, len(PICTURES))
        trajectory = None if is_merged(project) else project.load_trajectory()
        for name, picture in draw_pictures(project.load_mesh(), trajectory):
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
