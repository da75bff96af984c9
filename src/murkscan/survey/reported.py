"""What beside the stages stands in a report: the place on the Earth, and walls in elevation."""

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace

from ..errors import MissingResult
from ..io.json_files import load_json
from ..project import (
    GEOREFERENCE,
    MEASURE,
    MESH,
    Finished,
    GeoreferenceResult,
    MeasureResult,
    Project,
)
from ..report import ControlRow, DrawnWall, ModelSize, Placed
from .measured import measurement_files

_RECORD = ".stage.json"
"""What the name of a measurement's record ends in."""


def digest_beside(project: Project) -> dict[str, str]:
    """Give a short text for each thing that a report shows beside the stages."""
    found = {f"wall {name}": finished.digest for name, finished in _find_walls(project)}
    placed = _find_place(project)
    return found if placed is None else {"georeference": placed.digest, **found}


def tell_beside(project: Project, model: ModelSize) -> ModelSize:
    """Say where the model's files count from, where on the Earth it lies, and what of its walls.

    What is of an earlier cloud is left out.
    """
    placed = _find_place(project)
    return replace(
        model,
        origin=project.finished(MESH).result.origin,
        placed=None if placed is None else _as_placed(placed.result),
        walls=[wall for name, _ in _find_walls(project) if (wall := _load_wall(project, name))],
    )


def _find_place(project: Project) -> Finished[GeoreferenceResult] | None:
    with suppress(MissingResult):
        return project.finished(GEOREFERENCE)
    return None


def _as_placed(told: GeoreferenceResult) -> Placed:
    rows = [ControlRow(one.name, one.residual, one.sigma) for one in told.points]
    return Placed(told.crs, rows, told.rms, told.remarks, on_ship=told.hull is not None)


def _find_walls(project: Project) -> Iterator[tuple[str, Finished[MeasureResult]]]:
    for file in sorted((project.root / MEASURE.word).glob(f"*{_RECORD}")):
        name = file.name.removesuffix(_RECORD)
        with suppress(MissingResult):
            finished = project.finished(MEASURE, name)
            if finished.result.kind in ("wall", "dents"):
                yield name, finished


def _load_wall(project: Project, name: str) -> DrawnWall | None:
    """Load a list of anomalies; None of dents that an earlier version found, which has none."""
    content = load_json(measurement_files(project, name).checked(f"{name}.json"))
    told = content["details"]
    if "anomalies" not in told:
        return None
    return DrawnWall(name, told["anomalies"], told.get("pictures", []), kind=content["kind"])
