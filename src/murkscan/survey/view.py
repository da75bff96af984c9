"""Draw pictures of a scan's surface."""

import time
from pathlib import Path
from typing import Any

from ..page import Gallery, Note, Picture, Section, render_page
from ..project import Project
from ..view import PICTURES, draw_pictures
from .progress import Progress, silent


def draw_views(project: Project, *, progress: Progress = silent) -> dict[str, Any]:
    """Run the view stage: the isometric and six standard views, and two coloured by depth.

    Returns:
        The names of the pictures, in the order to show them; none for a scan without a surface.

    Raises:
        MissingResult: The mesh stage has not been finished.
        DeviceError: The disk is full.
    """
    source = project.finished("mesh")
    stage = project.stage("view", settings={}, inputs={"mesh": source.digest})
    if (result := stage.result()) is not None:
        return result
    since = time.monotonic()
    stage.begin()
    names: list[str] = []
    if source.counts()["faces"]:
        progress("view", 0, len(PICTURES))
        for name, picture in draw_pictures(project.load_mesh(), project.load_trajectory()):
            project.save_picture(name, picture)
            names.append(name)
            progress("view", len(names), len(PICTURES))
    result = {"pictures": names}
    project.save_view_page(_page(project, names))
    stage.finish(result, since=since)
    return result


def _page(project: Project, names: list[str]) -> str:
    """Show the pictures side by side."""
    title = Path(project.load_scan()["recording"]["path"]).name
    if not names:
        empty = Note("There is no surface to draw: no stripe was found in two frames or more.")
        return render_page("Pictures", [Section("", [empty])], subtitle=title)
    pictures = [Picture(f"{name}.png", name.replace("-", ", coloured by ")) for name in names]
    return render_page(
        "Pictures", [Section("", [Gallery(pictures, is_first_large=True)])], subtitle=title
    )
