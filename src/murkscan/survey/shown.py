"""What the page shows of a scan, from what its stages have left."""

from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import numpy as np

from ..errors import InputError, MissingResult
from ..io.deviation_files import load_deviation_ply
from ..project import (
    CLOUD,
    GEOREFERENCE,
    MEASURE,
    MESH,
    Project,
    digest,
    find_frame_times,
    find_trajectory,
    load_georeference,
)
from ..project.origin import name_recording
from ..types.arrays import Indices
from ..types.cloud import PointCloud
from ..types.mesh import Mesh
from ..view import Layer, Model, choose_fairly, cluster_vertices, model_of_scan
from .measured import measurement_files
from .shift_field import trace_shift_field

DEVIATION = "deviation"
"""The measurement that colours a scan unless another is named."""


def load_surface(project: Project) -> Mesh | None:
    """Load a scan's surface; None where it has none."""
    return project.load_mesh() if has_surface(project) else None


def load_model(
    project: Project, surface: Mesh | None, *, most: int, deviation: str = DEVIATION
) -> Model | None:
    """Load a scan to be shown; None where it has no points.

    Args:
        project: A scan, or a merged cloud, with a finished mesh stage.
        surface: Its surface, as `load_surface` gives it.
        most: Points, and vertices of the surface, to keep.
        deviation: Name of the measurement whose deviations it is coloured by, if it has been made.

    Raises:
        MissingResult: A stage has not been finished.
        FormatError: A file is damaged.
    """
    total = project.finished(CLOUD).result.points
    if total == 0:
        return None
    recording = project.load_scan().recording
    trajectory = find_trajectory(project)
    if recording is None and trajectory is not None:  # its alignment's errors belong to them
        trajectory = replace(trajectory, errors=None)
    mesh = None if surface is None else cluster_vertices(surface, most)
    rows = choose_fairly(total, most)
    if mesh is not None and mesh.points is not None:
        rows = np.union1d(rows, mesh.points)
    model = model_of_scan(
        title_of(project),
        load_rows(project, rows),
        rows=rows,
        num_points=total,
        mesh=mesh,
        trajectory=trajectory,
        frames=find_frame_times(project),
        is_timed=recording is not None and recording.is_timed,
        shift_field=None if recording is None else trace_shift_field(project),
        most=most,
    )
    model = replace(
        model, place=load_georeference(project) if georeference_digest(project) else None
    )
    if deviation_digest(project, deviation) is None:
        return model
    points, values, rows = load_deviation_ply(
        measurement_files(project, deviation).checked(f"{deviation}.ply")
    )
    if len(points) == 0:
        return model
    layer = Layer("deviation", values * 1e3, "mm", "RdBu_r", is_signed=True)
    return model.with_layer(layer, rows)


def georeference_digest(project: Project) -> str | None:
    """Give a short text that changes with where a scan lies.

    None where nobody has said where, or only where an earlier cloud lay.
    """
    with suppress(MissingResult):
        return project.finished(GEOREFERENCE).digest
    return None


def folder_of(project: Project) -> str:
    """Name a scan by its folder, as told from another of the same recording's name."""
    return "/".join(project.root.resolve().parts[-2:])


def has_surface(project: Project) -> bool:
    """Tell whether the finished mesh stage has found a surface."""
    return project.finished(MESH).result.faces > 0


def title_of(project: Project) -> str:
    """Name a scan by its recording, and a merged cloud by its folder."""
    recording = project.load_scan().recording
    return (
        project.root.resolve().name if recording is None else name_recording(Path(recording.path))
    )


def deviation_digest(project: Project, name: str) -> str | None:
    """Give a short text that changes with a measured deviation.

    None where there is none of this name, or none of the scan's present cloud.

    Raises:
        InputError: One is asked for that has not been measured.
    """
    with suppress(MissingResult):
        finished = project.finished(MEASURE, name)
        if f"{name}.ply" in finished.record.files:
            return digest([mark.blake2b for mark in finished.record.files.values()])
    if name != DEVIATION:
        raise InputError(
            f"{project.root} has no deviation {name} of its present cloud; run `murkscan measure "
            f"{project.root} deviation … --name {name}` first."
        )
    return None


def choose_points(project: Project, most: int) -> PointCloud:
    """Load a fair choice of a cloud that may be larger than memory."""
    return load_rows(project, choose_fairly(project.finished(CLOUD).result.points, most))


def load_rows(project: Project, rows: Indices) -> PointCloud:
    """Load some points of a cloud by their numbers, in increasing order, part by part."""
    start, parts = 0, []
    for block in project.iterate_cloud():
        low, high = np.searchsorted(rows, [start, start + len(block)])
        parts.append(block[rows[low:high] - start])
        start += len(block)
    return PointCloud.concatenate(parts)
