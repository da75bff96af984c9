"""The stages by name: what each one says, and which meaning its data have."""

from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from .georeference_result import GeoreferenceResult
from .results import (
    AcceptResult,
    CloudResult,
    ExtractResult,
    MeasureResult,
    MeshResult,
    MotionResult,
    ReportResult,
    SimulateResult,
    TriangulateResult,
    ViewResult,
)

R = TypeVar("R")


@dataclass(frozen=True)
class Kind(Generic[R]):
    """A stage."""

    word: str
    """Its name, which its folder and its command have, too."""
    result: type[R]
    """What it says when it is finished."""
    meaning: int
    """Meaning of its data. Whoever changes what the stage makes of the same inputs and settings
    raises this number: folders of earlier versions are then made anew."""


EXTRACT = Kind("extract", ExtractResult, meaning=3)
TRIANGULATE = Kind("triangulate", TriangulateResult, meaning=4)
MOTION = Kind("motion", MotionResult, meaning=5)
CLOUD = Kind("cloud", CloudResult, meaning=4)
MESH = Kind("mesh", MeshResult, meaning=3)
VIEW = Kind("view", ViewResult, meaning=2)
REPORT = Kind("report", ReportResult, meaning=2)

MEASURE = Kind("measure", MeasureResult, meaning=1)
"""Not in order: each measurement is one of its own, told from others in the folder by its name."""
GEOREFERENCE = Kind("georeference", GeoreferenceResult, meaning=1)
"""Not in order: what is exported after it lies in its grid."""
ACCEPT = Kind("accept", AcceptResult, meaning=1)
"""Not in order either: a scan may be held against artefacts once its cloud is there."""
SIMULATE = Kind("simulate", SimulateResult, meaning=1)
"""In a folder of its own, that of the recording."""

STAGES: tuple[Kind[Any], ...] = (EXTRACT, TRIANGULATE, MOTION, CLOUD, MESH, VIEW, REPORT)
"""The stages of a scan, in order."""
