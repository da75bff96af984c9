"""Where a scan's folder says that its model lies on the Earth, or on a ship."""

import numpy as np

from ..errors import MissingResult
from ..types.georeference import Georeference
from ..types.pose import Pose
from .folder import Project
from .georeference_result import GeoreferenceResult
from .kinds import GEOREFERENCE
from .stage import read_record, record_of


def is_georeferenced(project: Project) -> bool:
    """Tell whether somebody has said where a scan lies on the Earth."""
    return read_record(record_of(project.root / GEOREFERENCE.word)) is not None


def load_georeference(project: Project) -> Georeference | None:
    """Read where a scan lies on the Earth; None where nobody has said so.

    Raises:
        MissingResult: What was said is of an earlier cloud.
        FormatError: It is damaged.
    """
    if not is_georeferenced(project):
        return None
    try:
        return as_georeference(project.finished(GEOREFERENCE).result)
    except MissingResult as error:
        folder = project.root / GEOREFERENCE.word
        raise MissingResult(
            f"What {folder} says is of an earlier cloud: run `murkscan georeference` again, or "
            "delete that folder to stay in the model's own world."
        ) from error


def as_georeference(result: GeoreferenceResult) -> Georeference:
    """Make the way to the grid of the numbers in a record."""
    return Georeference(
        result.crs,
        result.wkt,
        np.array(result.origin),
        result.scale,
        Pose(np.array(result.rotation), np.array(result.translation)),
        np.array(result.covariance_of_turn_and_shift),
        result.hull,
    )
