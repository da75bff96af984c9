"""Lay a scan on control points, on the Earth or on a ship, whose places it then tells."""

import csv
import io
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ..geometry.control_fit import ControlFit, Mixup, centre_of, fit_control
from ..io.checksum import mark_file
from ..io.control_points import ControlPoints, read_control_points, read_hull_points
from ..io.grid import find_grid
from ..io.text import save_text
from ..io.values import as_plain
from ..project import CLOUD, GEOREFERENCE, GeoreferenceResult, Project, StageFiles
from ..project.georeference_result import ControlResult
from ..types.hull import HullFrame
from .markers import MarkerSearch, place_markers
from .progress import Progress, silent
from .stage_runner import run_stage

_STANDS_OUT = 4.03
"""Standard deviations that a residual's length exceeds once in a thousand: √χ²(0.999, 3)."""
_NO_HEIGHTS = (
    "the coordinate system does not say what heights count from; name theirs as well, as "
    "--crs EPSG:25832+7837"
)
_SIDES = Mixup(
    "port and starboard exchanged: correct the column side",
    ((1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, 1.0)),
)
_INSIDE = (
    "the camera would have looked at the ship from inside: port and starboard are exchanged, or "
    "the direction in which frames count; three points alone cannot tell"
)
_FACING, _ASIDE = 0.3, 0.05
"""Part of the mean direction to the camera that is athwartships, and distance of the points from
the centreline [m], from which it can be told whether the camera was outside."""


@dataclass(frozen=True)
class OnGrid:
    """Lay the model on the Earth, in a coordinate system."""

    crs: str
    """EPSG:N, or with that of the heights EPSG:N+M."""


def georeference(
    project: Project,
    control: Path,
    target: OnGrid | HullFrame,
    *,
    search: MarkerSearch,
    progress: Progress = silent,
) -> GeoreferenceResult:
    """Run the georeference stage: lay the model on control points.

    Args:
        project: A scan, or a merged cloud, with a finished cloud stage.
        control: The table of points; see `read_control_points`, and of a ship `read_hull_points`.
        target: A coordinate system on the Earth, or how places on a ship are told.
        search: Where the markers of points without a place on the model are looked for.
        progress: Told when it begins and ends.

    Returns:
        The transform, its covariance, and the residuals.

    Raises:
        MissingResult: The cloud stage has not been finished.
        FormatError: The table is none.
        NotEnoughData: It has fewer than three points, or a marker was not seen.
        Degenerate: They lie on a line.
        InputError: There is no such coordinate system, or the points are not those of the model.
        MissingDependency: pyproj is not installed.
    """
    settings: dict[str, object]
    if isinstance(target, HullFrame):
        points, settings = read_hull_points(control, target), {"hull": as_plain(target)}
    else:
        points, settings = read_control_points(control), {"crs": target.crs}
    if any(marker is not None for marker in points.markers):
        settings["markers"] = search.dictionary
    stage = project.stage(
        GEOREFERENCE,
        settings=settings,
        inputs={"cloud": project.finished(CLOUD).digest, "control": mark_file(control).blake2b},
    )

    def prepare() -> GeoreferenceResult:
        placed, markers = place_markers(project, points, search)
        if isinstance(target, HullFrame):
            return replace(_lay_on_hull(project, placed, target), markers=markers)
        return replace(_lay_on_grid(placed, target.crs), markers=markers)

    def make(result: GeoreferenceResult) -> GeoreferenceResult:
        files = StageFiles(project.root / GEOREFERENCE.word)
        with files.making("residuals.csv") as path:
            save_text(path, _as_table(result))
        return result

    return run_stage(project, stage, make, prepare=prepare, progress=progress)


def _lay_on_grid(points: ControlPoints, crs: str) -> GeoreferenceResult:
    origin = centre_of(points.places) if len(points.places) else np.zeros(3)
    grid = find_grid(crs, origin)
    metre = np.array([grid.scale, grid.scale, 1.0])
    on_ground = (points.places - origin) / metre
    fit = fit_control(points.on_model, on_ground, points.sigma)
    found = replace(_describe(points, fit), crs=grid.name, wkt=grid.wkt, scale=grid.scale)
    heights = () if grid.has_heights else (_NO_HEIGHTS,)
    return replace(found, origin=tuple(origin.tolist()), remarks=(*found.remarks, *heights))


def _lay_on_hull(project: Project, points: ControlPoints, hull: HullFrame) -> GeoreferenceResult:
    fit = fit_control(points.on_model, points.places, points.sigma, mixup=_SIDES)
    found = replace(_describe(points, fit), crs="the ship's own axes", hull=hull)
    normals = [block.normals.sum(axis=0, dtype=float) for block in project.iterate_cloud()]
    facing = fit.target_from_model.rotation @ np.sum(normals, axis=0)
    facing /= max(float(np.linalg.norm(facing)), 1e-300)
    off = float(points.places[:, 1].mean())
    if off * facing[1] < 0 and abs(facing[1]) > _FACING and abs(off) > _ASIDE:
        return replace(found, remarks=(*found.remarks, _INSIDE))
    return found


def _describe(points: ControlPoints, fit: ControlFit) -> GeoreferenceResult:
    """Tell a fit, in a frame that is still to be named."""
    pose = fit.target_from_model
    return GeoreferenceResult(
        crs="",
        wkt="",
        scale=1.0,
        origin=(0.0, 0.0, 0.0),
        rotation=tuple(tuple(row) for row in pose.rotation.tolist()),
        translation=tuple(pose.translation.tolist()),
        covariance_of_turn_and_shift=tuple(tuple(row) for row in fit.covariance.tolist()),
        points=tuple(
            ControlResult(name, tuple(residual.tolist()), float(sigma), float(ratio))
            for name, residual, sigma, ratio in zip(
                points.names, fit.residuals, points.sigma, fit.standardised, strict=True
            )
        ),
        rms=float(np.sqrt((fit.residuals**2).sum(axis=1).mean())),
        inflation=fit.inflation,
        remarks=_remarks(points, fit),
    )


def _remarks(points: ControlPoints, fit: ControlFit) -> tuple[str, ...]:
    said = []
    worst = int(np.argmax(fit.standardised))
    if fit.standardised[worst] > _STANDS_OUT:
        off = 1e3 * float(np.linalg.norm(fit.residuals[worst]))
        said.append(
            f"{points.names[worst]} is missed by {off:.1f} mm, {fit.standardised[worst]:.1f} of "
            "its standard deviations: look at it again, on the model and in the survey"
        )
    if fit.is_surprising:
        said.append(
            f"the residuals are {fit.inflation:.1f} times what the stated sigmas allow, and the "
            "intervals are widened by that: the model may be bent, or points be worse than stated"
        )
    return tuple(said)


def _as_table(result: GeoreferenceResult) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    axes = ("east", "north", "up") if result.hull is None else ("aft", "starboard", "up")
    writer.writerow(["name", *(f"{axis}_mm" for axis in axes), "sigma_mm", "standardised"])
    for one in result.points:
        off = [f"{1e3 * part:.3f}" for part in one.residual]
        writer.writerow([one.name, *off, f"{1e3 * one.sigma:g}", f"{one.standardised:.2f}"])
    return text.getvalue()
