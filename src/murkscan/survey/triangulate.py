"""Turn all stripes of a scan into profiles, one part after another."""

import os
import time
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from ..errors import Degenerate
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
    """Run the triangulate stage; parts that are there already are kept.

    Returns:
        Counts: points, and dropped, the centres whose ray does not meet the sheet.

    Raises:
        MissingResult: The extract stage has not been finished.
        Degenerate: No centre sees the sheet.
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
    since = time.monotonic()
    stage.begin()
    parts = [part for part, _ in project.load_stripe_notes()]

    points = 0

    def run(part: int) -> int:
        profile = project.load_profile_part(part)
        if profile is None:
            profile = triangulate(project.load_stripe_part(part), rig, method)
            project.save_profile_part(part, profile)
        return len(profile)

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for done, count in enumerate(pool.map(run, parts)):
            points += count
            progress("triangulate", done + 1, len(parts))
    centres = source.counts()["points"]
    if centres and not points:
        raise Degenerate(
            f"None of the {centres} stripe centres sees the laser's sheet in front of the camera: "
            "check the sign of baseline_mm or distance_mm, and the angle, in the rig file."
        )
    result = {"points": points, "dropped": centres - points}
    stage.finish(result, since=since)
    return result
