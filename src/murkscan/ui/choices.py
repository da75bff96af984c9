"""The names of the Choices, and what a user may set of them: one table for each Choice."""

import dataclasses
import importlib
from typing import TYPE_CHECKING, Any, Literal

from ..errors import InputError
from .values import read_box

if TYPE_CHECKING:
    from ..cloud import AbstractOutlierRule
    from ..extract import AbstractExtractor
    from ..mesh import AbstractMesher
    from ..triangulate import AbstractTriangulation

ExtractorName = Literal["threshold-skeleton", "gray-gravity", "gaussian", "steger", "murk"]
MethodName = Literal["ray-sheet", "equation-4"]
MesherName = Literal["grid", "poisson"]

_LARGEST = 1e5
"""No setting of any Choice is meant to be as large as this."""

_EXTRACTORS: dict[ExtractorName, str] = {
    "threshold-skeleton": "ThresholdSkeleton",
    "gray-gravity": "GrayGravity",
    "gaussian": "GaussianFit",
    "steger": "Steger",
    "murk": "Murk",
}
_METHODS: dict[MethodName, str] = {"ray-sheet": "RaySheet", "equation-4": "BaselineAngle"}
_MESHERS: dict[MesherName, str] = {"grid": "GridMesh", "poisson": "Poisson"}


def make_extractor(name: ExtractorName, settings: tuple[str, ...]) -> "AbstractExtractor":
    """Make the extractor of a name, with settings given as `field=value`."""
    return _make("extract", _EXTRACTORS[name], settings)


def make_method(name: MethodName) -> "AbstractTriangulation":
    """Make the triangulation of a name."""
    return _make("triangulate", _METHODS[name], ())


def make_mesher(name: MesherName, settings: tuple[str, ...]) -> "AbstractMesher":
    """Make the mesher of a name, with settings given as `field=value`."""
    return _make("mesh", _MESHERS[name], settings)


def make_rules(
    volume_m: str | None, *, min_posterior: float = 0.5
) -> "tuple[AbstractOutlierRule, ...]":
    """Make the reasons to take a point out of a cloud, in the order in which they are asked.

    Args:
        volume_m: What is wanted, as two corners X,Y,Z,X,Y,Z [m]; None: all of it.
        min_posterior: Probability to be the surface below which a point goes.

    Raises:
        InputError: One of them cannot be.
    """
    corners = None if volume_m is None else read_box("--volume-m", volume_m)
    from ..cloud import Doubtful, Outside, SeenThrough, Sparse

    wanted = () if corners is None else (Outside(*corners),)
    return (Doubtful(min_posterior), *wanted, Sparse(), SeenThrough())


def check_settings(settings: tuple[str, ...]) -> None:
    """Refuse settings that are not written as NAME=NUMBER, before a stage is loaded for them.

    Raises:
        InputError: One of them is not.
    """
    for setting in settings:
        name, _, text = setting.partition("=")
        if not name or not text:
            raise InputError(f"--set {setting!r} is no setting; give --set NAME=NUMBER.")
        _parse(setting, text, float)


def _make(stage: str, choice: str, settings: tuple[str, ...]) -> Any:
    final = getattr(importlib.import_module(f"murkscan.{stage}"), choice)
    defaults = final()
    types = {field.name: field.type for field in dataclasses.fields(final)}
    values = {}
    for setting in settings:
        name, _, text = setting.partition("=")
        if name not in types or not text:
            raise InputError(
                f"{setting!r} is no setting of {choice}; give --set NAME=NUMBER with a NAME of "
                f"{', '.join(types)}."
            )
        values[name] = _parse(setting, text, types[name])
    return dataclasses.replace(defaults, **values)


def _parse(setting: str, text: str, kind: Any) -> int | float:
    try:
        number = int(text) if kind in (int, int | None) else float(text)
    except ValueError as error:
        wanted = "a whole number" if kind in (int, int | None) else "a number"
        raise InputError(f"--set {setting}: {text!r} is not {wanted}.") from error
    if not abs(number) < _LARGEST:
        raise InputError(f"--set {setting}: {text} is not a number below {_LARGEST:g}.")
    return number
