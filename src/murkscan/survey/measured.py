"""What a measurement leaves in OUT/measure: a stage of its own, told from others by its name."""

import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from importlib.metadata import version
from typing import Any

import numpy as np

from ..errors import InputError
from ..io.json_files import save_json
from ..project import CLOUD, MEASURE, MeasureResult, Project, StageFiles, load_georeference
from ..types.measurement import Measurement
from ..types.quantity import Quantity
from .progress import silent
from .stage_runner import make_stage

_NAME = re.compile(r"[\w][\w.-]*", re.ASCII)
_TAKEN = ("stage", ".stage")
"""What a name is not, or does not end in: the names of records do."""

Write = Callable[[StageFiles], Mapping[str, object]]
"""Writes the files beside the numbers, and gives what more is to be said of them."""


def measurement_files(project: Project, name: str) -> StageFiles:
    """Give the files of a measurement, OUT/measure/<name>….

    Raises:
        InputError: The name is none for a file.
    """
    if not _NAME.fullmatch(name) or name == _TAKEN[0] or name.endswith(_TAKEN[1]):
        raise InputError(
            f"{name!r} is no name for a measurement; take letters, digits, - and _, such as bow."
        )
    return StageFiles(project.root / MEASURE.word, name)


@contextmanager
def measuring(project: Project, name: str | None) -> Iterator[None]:
    """Hold a scan's folder while it is measured.

    Raises:
        InputError: The name is none for a file, or another run is at work in the folder.
        MissingResult: The cloud stage has not been finished.
    """
    if name is not None:
        measurement_files(project, name)
    project.finished(CLOUD)
    with project.hold():
        yield


def keep_measurement(
    project: Project,
    name: str,
    measured: Measurement,
    *,
    write: Write = lambda files: {},
    settings: Mapping[str, Any] | None = None,
) -> Measurement:
    """Write a measurement, what it was taken from, and the files that belong to it.

    Args:
        project: What was measured.
        name: What to call it.
        measured: The numbers.
        write: Writes what else belongs to it.
        settings: Of these files; another measurement of the name takes the place of all.

    Returns:
        The measurement with all details.

    Raises:
        InputError: The name is none for a file, or a number is not finite.
        DeviceError: The disk is full or cannot be written.
    """
    files, cloud = measurement_files(project, name), project.finished(CLOUD).digest
    stage = project.stage(
        MEASURE,
        settings={"kind": measured.kind, **(settings or {})},
        inputs={"cloud": cloud},
        label=name,
    )
    details = dict(measured.details)
    if measured.places and (place := load_georeference(project)) is not None:
        told = place.tell(np.array(list(measured.places.values())))
        details["places"] = {
            what: dict(zip(place.heads, row, strict=True))
            for what, row in zip(measured.places, told, strict=True)
        }

    def make(_: None) -> MeasureResult:
        details.update(write(files))
        content = {
            "format": 1,
            "kind": measured.kind,
            "murkscan": version("murkscan"),
            "inputs": {"cloud": cloud},
            "quantities": {_key(one): as_plain(one) for one in measured.quantities},
            "details": details,
            "remarks": list(measured.remarks),
        }
        with files.making(f"{name}.json") as path:
            save_json(path, content)
        return MeasureResult(measured.kind)

    make_stage(project, stage, make, prepare=lambda: None, progress=silent)
    return replace(measured, details=details)


def as_plain(quantity: Quantity) -> dict[str, Any]:
    """Give a quantity as plain values, all in its own unit."""
    low, high = quantity.interval
    return {
        "value": quantity.value,
        "sigma_independent": quantity.sigma_independent,
        "sigma_common": quantity.sigma_common,
        "interval_95": [low, high],
    }


def _key(quantity: Quantity) -> str:
    return f"{quantity.name}_{quantity.unit}" if quantity.unit else quantity.name
