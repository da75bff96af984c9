"""Show a scan's surface: pictures for print, and a page on which it is turned and measured."""

import time
from pathlib import Path
from typing import Any

from ..errors import InputError
from ..page import Gallery, Note, Picture, Section, render_page
from ..project import Project
from ..view import MOST, PICTURES, Model, draw_pictures, model_of_scan, render_viewer
from .progress import Progress, silent
from .shift_field import trace_shift_field


def draw_views(
    project: Project,
    *,
    other: Project | None = None,
    most: int = MOST,
    progress: Progress = silent,
) -> dict[str, Any]:
    """Run the view stage: nine pictures, the page that shows them, and the page with the model.

    Args:
        project: A scan with a finished mesh stage.
        other: Another one, in the same world, to change to on the page: before and after.
        most: Points, and vertices of the surface, that the page holds of a scan.
        progress: Told how many pictures are drawn.

    Returns:
        The names of the pictures, in the order to show them, none for a scan without a surface;
        and how many points the page shows.

    Raises:
        MissingResult: The mesh stage has not been finished.
        InputError: There are to be no points on the page.
        DeviceError: The disk is full.
    """
    if most < 1:
        raise InputError(f"The page must hold one point or more, got {most}.")
    scans = [project] if other is None else [project, other]
    inputs = {"mesh": project.finished("mesh").digest}
    if other is not None:
        inputs["other"] = f"{other.root} {other.finished('mesh').digest}"
    stage = project.stage("view", settings={"most": most}, inputs=inputs)
    if (result := stage.result()) is not None:
        return result
    since = time.monotonic()
    stage.begin()
    names = _draw(project, progress)
    title = _title(project)
    project.save_pictures_page(_pictures_page(title, names))
    models = [_model(one, most) for one in scans if one.finished("cloud").counts()["points"]]
    page = render_viewer(models, title=title, pictures="pictures.html") if models else _empty(title)
    project.save_view_page(page)
    result = {"pictures": names, "points": models[0].num_measured if models else 0}
    stage.finish(result, since=since)
    return result


def _draw(project: Project, progress: Progress) -> list[str]:
    names: list[str] = []
    if project.finished("mesh").counts()["faces"]:
        progress("view", 0, len(PICTURES))
        for name, picture in draw_pictures(project.load_mesh(), project.load_trajectory()):
            project.save_picture(name, picture)
            names.append(name)
            progress("view", len(names), len(PICTURES))
    return names


def _model(project: Project, most: int) -> Model:
    has_surface = project.finished("mesh").counts()["faces"] > 0
    return model_of_scan(
        _title(project),
        project.load_cloud(),
        mesh=project.load_mesh() if has_surface else None,
        trajectory=project.load_trajectory(),
        frames=project.load_frame_times(),
        is_timed=project.load_scan()["recording"]["is_timed"],
        shift_field=trace_shift_field(project),
        most=most,
    )


def _title(project: Project) -> str:
    return Path(project.load_scan()["recording"]["path"]).name


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
