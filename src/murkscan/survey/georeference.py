"""Lay a scan on control points, so that what is exported lies in a coordinate system."""

import csv
import io
from pathlib import Path

import numpy as np

from ..geometry.control_fit import ControlFit, centre_of, fit_control
from ..io.checksum import mark_file
from ..io.control_points import ControlPoints, read_control_points
from ..io.grid import Grid, find_grid
from ..io.text import save_text
from ..project import CLOUD, GEOREFERENCE, GeoreferenceResult, Project, StageFiles
from ..project.results import ControlResult
from .progress import Progress, silent
from .stage_runner import run_stage

_STANDS_OUT = 4.03
"""Standard deviations that a residual's length exceeds once in a thousand: √χ²(0.999, 3)."""


def georeference(
    project: Project, control: Path, crs: str, *, progress: Progress = silent
) -> GeoreferenceResult:
    """Run the georeference stage: lay the model on control points.

    Args:
        project: A scan, or a merged cloud, with a finished cloud stage.
        control: The table of control points; see `read_control_points`.
        crs: Their coordinate system, as EPSG:N, or with that of the heights as EPSG:N+M.
        progress: Told when it begins and ends.

    Returns:
        The transform, its covariance, and the residuals.

    Raises:
        MissingResult: The cloud stage has not been finished.
        FormatError: The table is none.
        NotEnoughData: It has fewer than three points.
        Degenerate: They lie on a line.
        InputError: There is no such coordinate system, or the points are not those of the model.
        MissingDependency: pyproj is not installed.
    """
    points = read_control_points(control)
    stage = project.stage(
        GEOREFERENCE,
        settings={"crs": crs},
        inputs={"cloud": project.finished(CLOUD).digest, "control": mark_file(control).blake2b},
    )

    def prepare() -> GeoreferenceResult:
        origin = centre_of(points.places) if len(points.places) else np.zeros(3)
        grid = find_grid(crs, origin)
        metre = np.array([grid.scale, grid.scale, 1.0])
        on_ground = (points.places - origin) / metre
        fit = fit_control(points.on_model, on_ground, points.sigma)
        return _describe(points, grid, origin, fit)

    def make(result: GeoreferenceResult) -> GeoreferenceResult:
        files = StageFiles(project.root / GEOREFERENCE.word)
        with files.making("residuals.csv") as path:
            save_text(path, _as_table(result))
        return result

    return run_stage(project, stage, make, prepare=prepare, progress=progress)


def _describe(
    points: ControlPoints, grid: Grid, origin: np.ndarray, fit: ControlFit
) -> GeoreferenceResult:
    pose = fit.target_from_model
    return GeoreferenceResult(
        crs=grid.name,
        wkt=grid.wkt,
        scale=grid.scale,
        origin=tuple(origin.tolist()),
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
        remarks=_remarks(points, grid, fit),
    )


def _remarks(points: ControlPoints, grid: Grid, fit: ControlFit) -> tuple[str, ...]:
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
    if not grid.has_heights:
        said.append(
            "the coordinate system does not say what heights count from; name theirs as well, as "
            "--crs EPSG:25832+7837"
        )
    return tuple(said)


def _as_table(result: GeoreferenceResult) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["name", "east_mm", "north_mm", "up_mm", "sigma_mm", "standardised"])
    for one in result.points:
        off = [f"{1e3 * part:.3f}" for part in one.residual]
        writer.writerow([one.name, *off, f"{1e3 * one.sigma:g}", f"{one.standardised:.2f}"])
    return text.getvalue()
