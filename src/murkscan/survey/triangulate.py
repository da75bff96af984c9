"""Turn all stripes of a scan into profiles, one part after another."""

import os
from concurrent.futures import ThreadPoolExecutor

from ..errors import Degenerate
from ..project import EXTRACT, TRIANGULATE, Project, TriangulateResult, describe
from ..triangulate import AbstractTriangulation, triangulate
from ..types.rig import Rig
from .progress import Progress, silent
from .stage_runner import run_stage


def triangulate_stripes(
    project: Project,
    rig: Rig,
    method: AbstractTriangulation,
    *,
    progress: Progress = silent,
) -> TriangulateResult:
    """Run the triangulate stage; parts that are there already are kept.

    Raises:
        MissingResult: The extract stage has not been finished.
        Degenerate: No centre sees the sheet.
        DeviceError: The disk is full.
    """
    source = project.finished(EXTRACT)
    stage = project.stage(
        TRIANGULATE,
        settings={"method": describe(method)},
        inputs={"extract": source.digest, "rig": describe(rig)},
    )

    def make(parts: list[int]) -> TriangulateResult:
        points = _triangulate_parts(project, rig, method, parts, progress)
        if source.result.points and not points:
            raise Degenerate(
                f"None of the {source.result.points} stripe centres sees the laser's sheet in "
                "front of the camera: check the sign of baseline_mm or distance_mm, and the angle, "
                "in the rig file."
            )
        return TriangulateResult(points, dropped=source.result.points - points)

    def prepare() -> list[int]:
        return [part for part, _ in project.load_stripe_parts()]

    return run_stage(project, stage, make, prepare=prepare, progress=progress)


def _triangulate_parts(
    project: Project,
    rig: Rig,
    method: AbstractTriangulation,
    parts: list[int],
    progress: Progress,
) -> int:
    """Make the parts that are missing, and count the points of all."""
    there = project.find_profile_parts()

    def run(part: int) -> int:
        if part in there:
            return len(project.load_profile_part(part))
        profile = triangulate(project.load_stripe_part(part), rig, method)
        project.save_profile_part(part, profile)
        return len(profile)

    points = 0
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for done, count in enumerate(pool.map(run, parts)):
            points += count
            progress("triangulate", done + 1, len(parts))
    return points
