"""Compare a scan with a reference, and look for dents; keep what was found in OUT/measure."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from ..errors import InputError
from ..io.deviation_files import save_deviation_csv, save_deviation_ply
from ..io.images import write_image
from ..measure import (
    DentSearch,
    Sample,
    Selection,
    cut_out,
    deviation_from_mesh,
    deviation_from_smooth,
    draw_histogram,
    find_dents,
    measure_departure,
    remark_on_smooth,
    require_dent_sizes,
    sigma_of_points,
)
from ..measure.reference import Reference, check_unit, read_reference
from ..project import Project, StageFiles, find_trajectory, load_georeference
from ..types.dent import Dent
from ..types.deviation import Deviation
from ..types.measurement import Measurement
from ..types.mesh import Mesh
from ..types.quantity import Quantity
from ..types.trajectory import Trajectory
from ..view.render import render
from ..view.values import SignedValues
from ..view.views import front_view, standard_views
from .anomalies import save_dents
from .measured import as_plain, keep_measurement, measuring
from .sample import load_sample

_PICTURES = ("front", "isometric")


def load_reference(path: Path, *, unit: str = "m") -> Reference:
    """Read a mesh file, or the surface of a finished scan's folder, as it is.

    Args:
        path: A .ply, .stl, .obj or .glb file, or a scan's folder.
        unit: Unit of the file: m, cm, mm, in or ft.

    Raises:
        InputError: The unit is unknown, or given for a scan; or the file is of another format.
        FormatError: The file is no mesh, or has thousands of triangles in one place.
        MissingResult: The folder holds no scan with a surface.
    """
    check_unit(unit)
    if not path.is_dir():
        return read_reference(path, unit=unit)
    if unit != "m":
        raise InputError(f"{path} is a scan, which is in metres; leave out the unit {unit}.")
    return Reference(Project(path).load_mesh(), name=str(path))


def compare_scan(
    project: Project,
    reference: Reference,
    *,
    within: float,
    name: str = "deviation",
    selection: Selection | None = None,
) -> Measurement:
    """Measure how far a scan lies from a reference: numbers, table, cloud, pictures, histogram.

    Args:
        project: A scan with finished cloud and mesh stages.
        reference: The surface, in the scan's world.
        within: Distance beyond which a point does not belong to it [m].
        name: What to call it.
        selection: Which part of the scan; all of it unless given.

    Raises:
        MissingResult: The cloud or the mesh stage has not been finished.
        NotEnoughData: No point lies near the reference.
        InputError: The name is none for a file, or the distance is none.
    """
    with measuring(project, name):
        sample = load_sample(project, selection)
        surface = cut_out(project.load_mesh(), selection)
        deviation = deviation_from_mesh(
            sample, reference.mesh, within=within, sigma=reference.sigma_along
        )
        measured = measure_departure(sample, deviation)
        details = {**measured.details, **_how_aligned(reference), "within_m": within}

        def write(files: StageFiles) -> dict[str, object]:
            rows = _save_points(files, sample, deviation)
            _draw(files, find_trajectory(project), surface, sample, deviation)
            title = f"Scan against reference: {name}"
            with files.making(f"{name}-histogram.png") as path:
                write_image(path, draw_histogram(deviation.values, title=title))
            return {"points_per_row": rows}

        return keep_measurement(project, name, replace(measured, details=details), write=write)


def search_dents(
    project: Project,
    reference: Reference | None = None,
    *,
    smallest: float,
    largest: float,
    least_depth: float = 0.0,
    name: str = "dents",
    selection: Selection | None = None,
) -> DentSearch:
    """Find where a scan departs from a reference, or from its own smooth hull, by more than chance.

    Args:
        project: A scan with finished cloud and mesh stages.
        reference: The surface it should have, in the scan's world; None: a smooth one through the
            scan itself, that follows nothing narrower than `largest`.
        smallest: Width of the smallest dent looked for [m].
        largest: Width of the largest one [m]; farther away a point is none of the reference.
        least_depth: Depth below which none is told [m].
        name: What to call it.
        selection: Which part of the scan; all of it unless given.

    Raises:
        MissingResult: The cloud or the mesh stage has not been finished.
        NotEnoughData: The part is too small.
        InputError: The name is none for a file, or a size is not one.
    """
    require_dent_sizes(smallest=smallest, largest=largest, least_depth=least_depth)
    with measuring(project, name):
        sample = load_sample(project, selection)
        surface = cut_out(project.load_mesh(), selection)
        if reference is None:
            deviation = deviation_from_smooth(sample, largest=largest)
        else:
            deviation = deviation_from_mesh(
                sample, reference.mesh, within=largest, sigma=reference.sigma_along
            )
        search = find_dents(sample, deviation, smallest=smallest, least_depth=least_depth)
        if reference is None:
            search = replace(search, remarks=remark_on_smooth(sample, deviation, largest))

        def write(files: StageFiles) -> dict[str, object]:
            _save_points(files, sample, deviation)
            trajectory = find_trajectory(project)
            _draw(files, trajectory, surface, sample, deviation)
            return save_dents(
                files,
                search.dents,
                load_georeference(project),
                surface=surface,
                colours=SignedValues(sample.cloud.points, deviation.values),
                view=front_view(trajectory),
            )

        keep_measurement(project, name, _as_measurement(search, reference), write=write)
    return search


def _as_measurement(search: DentSearch, reference: Reference | None) -> Measurement:
    details: dict[str, object] = {
        "dents": [_as_plain(dent) for dent in search.dents],
        "unsure": search.num_unsure,
    }
    if reference is not None:
        details |= _how_aligned(reference)
    threshold = Quantity("threshold", search.threshold, "m", search.noise, 0.0)
    return Measurement("dents", (threshold,), details, search.remarks)


def _save_points(files: StageFiles, sample: Sample, deviation: Deviation) -> int:
    points, sigma = sample.cloud.points, sigma_of_points(sample, deviation)
    with files.making(f"{files.label}.ply") as path:
        save_deviation_ply(path, points, deviation, sigma, sample.rows)
    with files.making(f"{files.label}.csv") as path:
        return save_deviation_csv(path, points, deviation.values, sigma)


def _draw(
    files: StageFiles,
    trajectory: Trajectory | None,
    surface: Mesh,
    sample: Sample,
    deviation: Deviation,
) -> None:
    """Draw the scan's surface, coloured by its deviation."""
    colours = SignedValues(sample.cloud.points, deviation.values)
    for view in standard_views(trajectory):
        if view.name in _PICTURES:
            with files.making(f"{files.label}-{view.name}.png") as path:
                write_image(path, render(surface, view, colours=colours))


def _how_aligned(reference: Reference) -> dict[str, object]:
    alignment = reference.alignment
    if alignment is None:
        return {"aligned": False}
    moved = alignment.correction.inverse()
    return {
        "aligned": True,
        "reference_moved_m": moved.translation.tolist(),
        "reference_turned_wxyz": moved.as_quaternion()[0].tolist(),
        "alignment_rms_m": alignment.rms,
        "open_directions": [str(direction) for direction in alignment.open_directions],
    }


def _as_plain(dent: Dent) -> dict[str, object]:
    return {
        "place_m": dent.place.tolist(),
        "sigma_place_m": np.asarray(dent.sigma_place).tolist(),
        "depth_m": as_plain(dent.depth),
        "diameter_m": as_plain(dent.diameter),
        "volume_m3": as_plain(dent.volume),
        "points": dent.num_points,
    }
