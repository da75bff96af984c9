"""Measure a finished scan, and keep what was found in OUT/measure."""

from collections.abc import Callable, Collection

import numpy as np

from ..errors import InputError, MissingResult
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
from ..project import Project, StageFiles, load_georeference
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
                save_section_csv(path, drawing, section.lines, sigmas, place=place)
        if "svg" in formats:
            with files.making(f"{name}.svg") as path:
                save_section_svg(path, drawing, title=name)
        if "dxf" in formats:
            with files.making(f"{name}.dxf") as path:
                save_section_dxf(path, drawing)
        return {}

    with measuring(project, name):
        place = load_georeference(project)
        up = None if place is None else place.ground_from_model.rotation[2]
        section = cut_section(project.load_mesh(), plane, up=up)
        measured, sigmas = measure_section(section, load_sample(project))
        drawing, chosen = section.as_drawing(), {"formats": sorted(formats)}
        return keep_measurement(project, name, measured, write=write, settings=chosen)


def plane_across_ship(project: Project, *, frame: float | None, from_bow: float | None) -> Plane:
    """Give the plane across a ship at a frame, or at a distance from the bow, in the scan's world.

    Args:
        project: A scan that was laid on the points of a ship.
        frame: Number of the frame, where these were told.
        from_bow: The distance, where there were no frames [m].

    Raises:
        MissingResult: The scan has not been laid on a ship's points.
        InputError: Its points tell no frames, or nothing but frames.
    """
    place = load_georeference(project)
    if place is None or place.hull is None:
        raise MissingResult(
            f"{project.root} does not say where on a ship it lies; run `murkscan georeference "
            f"{project.root} --hull points.csv` first."
        )
    has_frames = place.hull.frame_spacing is not None
    station = frame if has_frames else from_bow
    if station is None:
        flag = "--at-frame" if has_frames else "--from-bow-m"
        raise InputError(f"The places of {project.root} are told otherwise: give {flag}.")
    where = place.place_back(np.array([[place.hull.aft_of(station), 0.0, 0.0]]))[0]
    return Plane.through(where, place.ground_from_model.rotation[0])


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
