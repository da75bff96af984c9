"""Draw pictures of a scan's surface."""

from typing import Any

from ..project import Project
from ..view import VIEWS, draw_view
from .progress import Progress, silent


def draw_views(project: Project, *, progress: Progress = silent) -> dict[str, Any]:
    """Run the view stage: the isometric and six standard views, plain and coloured by depth.

    Returns:
        The names of the pictures; none for a scan without a surface.

    Raises:
        MissingResult: The mesh stage has not been finished.
        DeviceError: The disk is full.
    """
    source = project.finished("mesh")
    stage = project.stage("view", settings={}, inputs={"mesh": source.digest})
    if (result := stage.result()) is not None:
        return result
    stage.begin()
    names: list[str] = []
    if source.counts()["faces"]:
        mesh = project.load_mesh()
        for done, view in enumerate(VIEWS):
            for colours, suffix in (("plain", ""), ("depth", "_depth")):
                name = f"{view}{suffix}.png"
                project.save_picture("view", name, draw_view(mesh, view, colours=colours))
                names.append(name)
            progress("view", done + 1, len(VIEWS))
    stage.finish({"pictures": names})
    return {"pictures": names}
