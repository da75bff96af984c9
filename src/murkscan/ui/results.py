"""What a stage says when it is finished, as sentences for people."""

from functools import singledispatch
from typing import Any

from ..project.results import (
    CloudResult,
    ExtractResult,
    MeshResult,
    MotionResult,
    ReportResult,
    TriangulateResult,
    ViewResult,
)
from ..types.lengths import in_mm
from ..types.paint_pull import PaintPull

_FEW_STRIPES = 0.5
"""Share of frames without a stripe from which that is worth a word of advice."""
_MANY_OUTLIERS = 0.2
"""Share of points taken out from which that is worth one."""
_CAUSES = {
    "posterior": "too improbable to be the surface",
    "volume": "outside of the volume that was asked for",
    "density": "that stood alone",
    "visibility": "in front of a surface that was seen through them, or mirrored behind it",
}
"""Why points are taken out of a cloud, by the names of the rules."""
_GAPS = {
    "no_stripe": "no stripe was found in the frame",
    "unreadable": "frames could not be read",
    "too_fast": "the camera moved too fast for its frame rate",
    "too_far": "the surface was too far for this water and light",
    "occluded": "an edge hid the surface from the laser or from the camera",
    "too_dark": "no light came back from there, though it was near enough",
    "far_or_dark": "no light came back from there",
}
"""Why a part of the surface is missing, by the names of the report's causes."""


@singledispatch
def tell_made(result: Any) -> str:
    """Say what a stage has made, in one line; the same for whoever asks."""
    raise TypeError(f"{type(result).__name__} is no stage's result")


@singledispatch
def tell_quality(result: Any) -> tuple[str, ...]:
    """Say how good it is, a sentence each; none where there is nothing to be said."""
    return ()


@tell_made.register
def _(result: ExtractResult) -> str:
    return (
        f"{result.points:,} stripe centres in {result.frames:,} frames read, "
        f"{result.skipped:,} skipped"
    )


@tell_quality.register
def _(result: ExtractResult) -> tuple[str, ...]:
    empty, frames = result.frames_without_stripe, max(result.frames, 1)
    if not empty:
        return ("every frame that was read shows a stripe",)
    line = f"{empty:,} frames ({empty / frames:.0%}) show no stripe"
    if empty < _FEW_STRIPES * frames:
        return (line,)
    return (f"{line}: look at extract/overlay, where what was found is drawn over the frames",)


@tell_made.register
def _(result: TriangulateResult) -> str:
    return f"{result.points:,} points on profiles"


@tell_quality.register
def _(result: TriangulateResult) -> tuple[str, ...]:
    dropped = (
        f"{result.dropped:,} stripe centres gave no point: their ray does not meet the laser's "
        "sheet in front of the camera"
    )
    return (
        dropped if result.dropped else "every stripe centre gave a point",
        *(_tell_pull(pull) for pull in result.paint_pulls),
    )


def _tell_pull(pull: PaintPull) -> str:
    """Say what was taken back, where the stripe's brightness changes by a tenth."""
    return (
        f"laser {pull.laser}: where paint changes the brightness by 10 % from frame to frame, it "
        f"had pulled the stripe by {0.1 * abs(pull.shift):.4f} px "
        f"(1σ {0.1 * pull.sigma:.4f} px), which was taken back"
    )


@tell_made.register
def _(result: MotionResult) -> str:
    timed = f" in {result.duration:.1f} s" if result.duration else ""
    return f"{result.poses:,} poses along {result.length:.3f} m{timed}"


@tell_quality.register
def _(result: MotionResult) -> tuple[str, ...]:
    if not result.frames_without_pose:
        return ("every frame has a pose",)
    return (f"{result.frames_without_pose:,} frames have no pose, and give no points",)


@tell_made.register
def _(result: CloudResult) -> str:
    asked = result.outliers_by.get("volume", 0)
    said = f"{result.points:,} points, {result.outliers - asked:,} outliers taken out"
    return f"{said}, {asked:,} left out with the volume" if asked else said


@tell_quality.register
def _(result: CloudResult) -> tuple[str, ...]:
    lines = [
        f"taken out: {count:,} points {_CAUSES.get(cause, f'by the rule {cause}')}"
        for cause, count in result.outliers_by.items()
        if count
    ]
    doubted = result.outliers - result.outliers_by.get("volume", 0)
    if doubted > _MANY_OUTLIERS * max(result.points + doubted, 1):
        lines.append(
            "that is much: the water may be too murky here, or something else glitters; look at "
            "extract/overlay"
        )
    return tuple(lines)


@tell_made.register
def _(result: MeshResult) -> str:
    filled = f", {result.faces_filled:,} of them across holes" if result.faces_filled else ""
    return f"a surface of {result.faces:,} triangles{filled}"


@tell_quality.register
def _(result: MeshResult) -> tuple[str, ...]:
    if not result.faces:
        return ("there is no surface: look at extract/overlay to see what was found",)
    if result.holes_left is None:
        return ()
    return (f"{result.holes_closed:,} holes closed, {result.holes_left:,} larger ones left",)


@tell_made.register
def _(result: ViewResult) -> str:
    pictures = f"{len(result.pictures)} pictures and " if result.pictures else ""
    return f"{pictures}a page with {result.points:,} points, to turn, cut and measure"


@tell_quality.register
def _(result: ViewResult) -> tuple[str, ...]:
    return (result.relation,) if result.relation else ()


@tell_made.register
def _(result: ReportResult) -> str:
    return f"a page on {result.frames:,} frames and {result.points:,} points"


@tell_quality.register
def _(result: ReportResult) -> tuple[str, ...]:
    return (*_tell_coverage(result), *_tell_trust(result), *_tell_calibration(result))


def _tell_coverage(result: ReportResult) -> list[str]:
    if result.covered is None:
        return []
    line = f"{_percent(result.covered)} of the surface passed over is covered"
    if result.largest_gap is None:
        return [line]
    return [f"{line}; most of the rest is missing since {_GAPS[result.largest_gap]}"]


def _tell_trust(result: ReportResult) -> list[str]:
    if result.half_width is None or result.own_half_width is None:
        return []
    line = f"a typical point is known to ± {in_mm(result.own_half_width)} mm (95 %) by its noise"
    if result.half_width > result.own_half_width:
        line += f", to ± {in_mm(result.half_width)} mm with what calibration and motion add"
    return [line, *(text[0].lower() + text[1:].rstrip(".") for text in result.unstated)]


def _tell_calibration(result: ReportResult) -> list[str]:
    if not result.steps_with_advice:
        return []
    return [f"the calibration of the {', '.join(result.steps_with_advice)} could be better: see "
            "its verdict in the report"]  # fmt: skip


def _percent(share: float) -> str:
    """Write a share; what is nearly all is not written as all."""
    return f"{100 * share:.0f} %" if share < 0.99 or share == 1 else f"{100 * share:.1f} %"
