"""Show a scan's surface: pictures for print, and a page on which it is turned and measured."""

from pathlib import Path

from ..errors import InputError
from ..io.video import writing_video
from ..page import Gallery, Note, Picture, Section, render_page
from ..project import MESH, VIEW, Project, ViewResult, find_trajectory
from ..types.mesh import Mesh
from ..view import MOST, PICTURES, TURN, draw_pictures, draw_turn, render_viewer
from .compared import Compared, compare_models
from .progress import Progress, silent
from .shown import (
    DEVIATION,
    deviation_digest,
    georeference_digest,
    load_model,
    load_surface,
    title_of,
)
from .stage_runner import run_stage

_FILM, _RATE = (1280, 720), 24.0
"""Size of a film [px], and pictures a second."""


def draw_views(
    project: Project,
    *,
    other: Project | None = None,
    align: bool = True,
    deviation: str = DEVIATION,
    most: int = MOST,
    title: str | None = None,
    progress: Progress = silent,
) -> ViewResult:
    """Run the view stage: nine pictures, the page that shows them, and the page with the model.

    Args:
        project: A scan, or a merged cloud, with a finished mesh stage.
        other: Another one, to change to on the page: before and after.
        align: Whether the other one is laid on the scan by ICP; otherwise it stays where its poses
            put it.
        deviation: Name of the measurement whose deviations the page shows, if it has been made.
        most: Points, and vertices of the surface, that the page holds of a scan.
        title: What stands above the page; the recording's name unless given.
        progress: Told how many pictures are drawn.

    Returns:
        What was drawn: no pictures for a scan without a surface.

    Raises:
        MissingResult: The mesh stage has not been finished.
        Degenerate: The scans do not overlap.
        InputError: There are to be no points on the page, or a deviation has not been measured.
        DeviceError: The disk is full.
    """
    if most < 1:
        raise InputError(f"The page must hold one point or more, got {most}.")
    inputs = {"mesh": project.finished(MESH).digest}
    if (measured := deviation_digest(project, deviation)) is not None:
        inputs["deviation"] = measured
    if (placed := georeference_digest(project)) is not None:
        inputs["georeference"] = placed
    if other is not None:
        inputs["other"] = f"{other.root} {other.finished(MESH).digest}"
    settings: dict[str, object] = {"most": most, "align": align and other is not None}
    if title is not None:
        settings["title"] = title
    stage = project.stage(VIEW, settings=settings, inputs=inputs)

    def prepare() -> tuple[Mesh | None, Compared]:
        surface = load_surface(project)
        if other is not None:
            return surface, compare_models(
                project, surface, other, align=align, deviation=deviation, most=most
            )
        model = load_model(project, surface, most=most, deviation=deviation)
        return surface, Compared([] if model is None else [model], "", None)

    def make(prepared: tuple[Mesh | None, Compared]) -> ViewResult:
        surface, shown = prepared
        names = [] if surface is None else _draw(project, surface, progress)
        name = title or title_of(project)
        project.save_view_page("pictures", _pictures_page(name, names))
        project.save_view_page("index", _page(name, shown))
        points = sum(model.num_measured for model in shown.models)
        return ViewResult(tuple(names), points, shown.relation, shown.alignment)

    return run_stage(project, stage, make, prepare=prepare, progress=progress)


def film_scan(project: Project, path: Path, *, progress: Progress = silent) -> None:
    """Write a film of the surface turned once round, as MP4 (H.264).

    Args:
        project: A scan, or a merged cloud, with a finished mesh stage.
        path: The file, ending in .mp4.
        progress: Told how many pictures are drawn.

    Raises:
        InputError: The file has another suffix.
        MissingResult: The mesh stage has not been finished.
        NotEnoughData: The scan has no surface.
        DeviceError: The disk is full.
    """
    if path.suffix.lower() != ".mp4":
        raise InputError(f"A film is written as .mp4, not as {path.name}.")
    project.finished(MESH)
    pictures = draw_turn(project.load_mesh(), find_trajectory(project), size=_FILM)
    with writing_video(path, _FILM, rate=_RATE, codec="h264", crf=20, is_colour=True) as write:
        for number, picture in enumerate(pictures):
            write(picture, number / _RATE)
            progress("film", number + 1, TURN)


def _page(title: str, shown: Compared) -> str:
    if not shown.models:
        return _empty(title)
    return render_viewer(
        shown.models, title=title, pictures="pictures.html", relation=shown.relation
    )


def _draw(project: Project, surface: Mesh, progress: Progress) -> list[str]:
    names: list[str] = []
    progress("view", 0, len(PICTURES))
    for name, picture in draw_pictures(surface, find_trajectory(project)):
        project.save_picture(name, picture)
        names.append(name)
        progress("view", len(names), len(PICTURES))
    return names


def _pictures_page(title: str, names: list[str]) -> str:
    """Show the pictures side by side."""
    if not names:
        note = Note("There is no surface to draw: no stripe was found in two frames or more.")
        return render_page("Pictures", [Section("", [note])], subtitle=title)
    pictures = [Picture(f"{name}.png", PICTURES[name]) for name in names]
    gallery = Gallery(pictures, is_first_large=True)
    return render_page("Pictures", [Section("", [gallery])], subtitle=title)


def _empty(title: str) -> str:
    note = Note("There is nothing to show: no point was found. Look at extract/overlay.", "warning")
    return render_page("Model", [Section("", [note])], subtitle=title)
