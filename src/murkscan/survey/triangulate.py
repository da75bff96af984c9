"""Turn all stripes of a scan into profiles, one part after another."""

import os
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from ..project import Project
from ..triangulate import AbstractTriangulation, triangulate
from ..types.rig import Rig
from .progress import Progress, silent
from .settings import describe


def triangulate_stripes(
    project: Project,
    rig: Rig,
    method: AbstractTriangulation,
    *,
    progress: Progress = silent,
) -> dict[str, Any]:
    """Run the triangulate stage.

    Returns:
        Counts: points, and dropped, the centres whose ray does not meet the sheet.

    Raises:
        MissingResult: The extract stage has not been finished.
        DeviceError: The disk is full.
    """
    source = project.finished("extract")
    stage = project.stage(
        "triangulate",
        settings={"method": describe(method)},
        inputs={"extract": source.digest, "rig": describe(rig)},
    )
    if (result := stage.result()) is not None:
        return result
    stage.begin()
    parts = [part for part, _ in project.load_stripe_notes()]

    points = 0

    def run(part: int) -> int:
        profile = triangulate(project.load_stripe_part(part), rig, method)
        project.save_profile_part(part, profile)
        return len(profile)

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for done, count in enumerate(pool.map(run, parts)):
            points += count
            progress("triangulate", done + 1, len(parts))
    result = {"points": points, "dropped": source.counts()["points"] - points}
    stage.finish(result)
    return result
