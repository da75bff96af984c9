"""Make a surface from a scan's cloud."""

import time
from typing import Any

from ..mesh import AbstractMesher
from ..project import Project
from .progress import Progress, silent
from .settings import describe


def build_mesh(
    project: Project, mesher: AbstractMesher, *, progress: Progress = silent
) -> dict[str, Any]:
    """Run the mesh stage.

    Args:
        project: A scan with a finished cloud stage.
        mesher: The way to make a surface.
        progress: Told when it begins and when it is done.

    Returns:
        Counts: vertices and faces; both 0 for a cloud that has no two neighbouring profiles.

    Raises:
        MissingResult: The cloud stage has not been finished.
        MissingDependency: The mesher needs an extra that is not installed.
        DeviceError: The disk is full.
    """
    stage = project.stage(
        "mesh",
        settings={"mesher": describe(mesher)},
        inputs={"cloud": project.finished("cloud").digest},
    )
    if (result := stage.result()) is not None:
        return result
    since = time.monotonic()
    progress("mesh", 0, None)
    mesh = mesher.mesh(project.load_cloud())
    stage.begin()
    if len(mesh.faces):
        project.save_mesh(mesh)
    result = {"vertices": len(mesh.vertices), "faces": len(mesh.faces)}
    stage.finish(result, since=since)
    progress("mesh", 1, 1)
    return result
