"""Measure a finished scan, and keep what was found in OUT/measure."""

from collections.abc import Callable, Collection

from ..io.section_csv import save_section_csv
from ..io.section_dxf import save_section_dxf
from ..io.section_svg import save_section_svg
from ..measure import (
    Sample,
    Selection,
    cut_out,
    cut_section,
    measure_area,
    measure_enclosed,
    measure_section,
    measure_step,
    measure_volume,
    trust_plane,
)
from ..project import Project, StageFiles
from ..types.measurement import Measurement
from ..types.plane import Plane
from .measured import keep_measurement, measuring
from .sample import load_sample


def measure_points(
    project: Project,
    measure: Callable[[Sample], Measurement],
    *,
    name: str | None = None,
    selection: Selection | None = None,
) -> Measurement:
    """Take one measure of a scan's points, and write measure/<name>.json.

    Args:
        project: A scan with a finished cloud stage.
        measure: What to measure, such as `murkscan.measure.measure_sphere`.
        name: What to call it; what was measured unless given.
        selection: Which part of the scan; all of it unless given.

    Raises:
        MissingResult: The cloud stage has not been finished.
        EstimationError: The points do not determine it.
        InputError: The name is none for a file, or a point is not finite.
    """
    with measuring(project, name):
        measured = measure(load_sample(project, selection))
        return keep_measurement(project, name or measured.kind, measured)


def measure_cut(
    project: Project,
    plane: Plane,
    *,
    name: str = "section",
    formats: Collection[str] = ("svg", "csv"),
) -> Measurement:
    """Cut a scan's surface by a plane, and write the lines and measure/<name>.json.

    Args:
        project: A scan with a finished mesh stage.
        plane: The plane, in the world.
        name: What to call it.
        formats: Which of dxf, svg and csv to write.

    Raises:
        MissingResult: The mesh stage has not been finished.
        NotEnoughData: The plane does not meet the surface.
    """

    def write(files: StageFiles) -> dict[str, object]:
        if "csv" in formats:
            with files.making(f"{name}.csv") as path:
                save_section_csv(path, drawing, section.lines, sigmas)
        if "svg" in formats:
            with files.making(f"{name}.svg") as path:
                save_section_svg(path, drawing, title=name)
        if "dxf" in formats:
            with files.making(f"{name}.dxf") as path:
                save_section_dxf(path, drawing)
        return {}

    with measuring(project, name):
        section = cut_section(project.load_mesh(), plane)
        measured, sigmas = measure_section(section, load_sample(project))
        drawing, chosen = section.as_drawing(), {"formats": sorted(formats)}
        return keep_measurement(project, name, measured, write=write, settings=chosen)


def measure_stairs(
    project: Project, first: Selection, second: Selection, *, name: str = "step"
) -> Measurement:
    """Measure the step between two parts of a scan that are parallel planes.

    Raises:
        MissingResult: The cloud stage has not been finished.
        EstimationError: A part is too small, or is no plane.
        InputError: The name is none for a file.
    """
    with measuring(project, name):
        measured = measure_step(load_sample(project, first), load_sample(project, second))
        return keep_measurement(project, name, measured)


def measure_covered(
    project: Project, *, name: str = "area", selection: Selection | None = None
) -> Measurement:
    """Measure the area of a scan's surface.

    Raises:
        MissingResult: The mesh stage has not been finished.
        NotEnoughData: The selection holds no triangle.
        InputError: The name is none for a file, or sheets of the surface lie on one another.
    """
    with measuring(project, name):
        mesh = cut_out(project.load_mesh(), selection)
        return keep_measurement(project, name, measure_area(mesh, load_sample(project)))


def measure_above(
    project: Project,
    base: Plane | Selection,
    *,
    name: str = "volume",
    selection: Selection | None = None,
) -> Measurement:
    """Measure the volume between a scan's surface and a plane.

    Args:
        project: A scan with finished cloud and mesh stages.
        base: The plane, in the world; or the part of the scan that it is fitted to, which then
            counts positive what stands out towards the camera.
        name: What to call it.
        selection: Which part of the surface; all of it unless given.

    Raises:
        MissingResult: The mesh stage has not been finished.
        EstimationError: A part is too small, or the base is no plane.
        InputError: The name is none for a file, or sheets of the surface lie on one another.
    """
    with measuring(project, name):
        sample = load_sample(project)
        mesh = cut_out(project.load_mesh(), selection)
        if isinstance(base, Plane):
            measured = measure_volume(mesh, sample, base)
        else:
            fit, trust = trust_plane(load_sample(project, base))
            measured = measure_volume(mesh, sample, fit.shape, trust=(trust, fit.middle))
        return keep_measurement(project, name, measured)


def measure_inside(project: Project, *, name: str = "volume") -> Measurement:
    """Measure the volume that a scan's surface encloses.

    Raises:
        MissingResult: The mesh stage has not been finished.
        InputError: The surface is not closed, or the name is none for a file.
    """
    with measuring(project, name):
        measured = measure_enclosed(project.load_mesh(), load_sample(project))
        return keep_measurement(project, name, measured)
