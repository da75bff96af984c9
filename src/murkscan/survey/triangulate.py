"""Turn all stripes of a scan into profiles, one part after another."""

from contextlib import closing
from dataclasses import dataclass

from ..distribute import AbstractExecutor, Threads
from ..errors import Degenerate
from ..project import EXTRACT, TRIANGULATE, Project, TriangulateResult, describe
from ..triangulate import (
    AbstractTriangulation,
    learn_paint_pulls,
    triangulate,
    undo_paint_pull,
)
from ..types.paint_pull import PaintPull
from ..types.profile import Profile
from ..types.rig import Rig
from ..types.stripe import Stripe
from .progress import Progress, silent
from .stage_runner import run_stage

_SAMPLES = 16
"""Parts, spread over the recording, from which the pull of paint is learnt."""


def triangulate_stripes(
    project: Project,
    rig: Rig,
    method: AbstractTriangulation,
    *,
    executor: AbstractExecutor | None = None,
    progress: Progress = silent,
) -> TriangulateResult:
    """Run the triangulate stage; parts that are there already are kept.

    Args:
        project: Whose stripes they are.
        rig: The rig that recorded them.
        method: The way from pixels to points.
        executor: Who does it; threads unless given. The result is the same.
        progress: Told of each part.

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

    def make(prepared: tuple[list[int], tuple[PaintPull, ...]]) -> TriangulateResult:
        parts, pulls = prepared
        job = _Job(project, rig, method, frozenset(parts), pulls)
        points = _triangulate_parts(job, parts, executor or Threads(), progress)
        if source.result.points and not points:
            raise Degenerate(
                f"None of the {source.result.points} stripe centres sees the laser's sheet in "
                "front of the camera: check the sign of baseline_mm or distance_mm, and the angle, "
                "in the rig file."
            )
        return TriangulateResult(points, source.result.points - points, pulls)

    def prepare() -> tuple[list[int], tuple[PaintPull, ...]]:
        parts = [part for part, _ in project.load_stripe_parts()]
        sample = parts[:: -(-len(parts) // _SAMPLES) or 1]
        return parts, learn_paint_pulls(map(project.load_stripe_part, sample), rig)

    return run_stage(project, stage, make, prepare=prepare, progress=progress)


@dataclass(frozen=True, eq=False)
class _Job:
    """What every part needs."""

    project: Project
    rig: Rig
    method: AbstractTriangulation
    parts: frozenset[int]
    """All parts of the recording."""
    pulls: tuple[PaintPull, ...]

    def triangulate(self, part: int) -> tuple[int, Profile]:
        """Make one part."""
        stripe = self.project.load_stripe_part(part)
        if self.pulls:
            stripe = undo_paint_pull(stripe, self.pulls, self.rig, beside=self._load_beside(part))
        return part, triangulate(stripe, self.rig, self.method)

    def _load_beside(self, part: int) -> Stripe:
        """Read the parts before and after one."""
        near = [self.project.load_stripe_part(p) for p in (part - 1, part + 1) if p in self.parts]
        return Stripe.concatenate(near)


def _triangulate_parts(
    job: _Job, parts: list[int], executor: AbstractExecutor, progress: Progress
) -> int:
    """Make the parts that are missing, and count the points of all; this process alone writes."""
    there = job.project.find_profile_parts()
    points = sum(len(job.project.load_profile_part(part)) for part in parts if part in there)
    missing = [part for part in parts if part not in there]
    with closing(executor.map(job.triangulate, missing)) as made:
        for done, (part, profile) in enumerate(made, start=len(parts) - len(missing) + 1):
            job.project.save_profile_part(part, profile)
            points += len(profile)
            progress("triangulate", done, len(parts))
    return points
