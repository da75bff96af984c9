"""What a measurement leaves in OUT/measure."""

import re
from importlib.metadata import version
from pathlib import Path
from typing import Any

from ..errors import InputError
from ..io.json_files import save_json
from ..project import CLOUD, Project
from ..types.measurement import Measurement
from ..types.quantity import Quantity

_NAME = re.compile(r"[\w][\w.-]*", re.ASCII)


def measure_file(project: Project, name: str, suffix: str = "json") -> Path:
    """Give the file of a measurement: OUT/measure/<name>.<suffix>.

    Raises:
        InputError: The name is none for a file.
    """
    if not _NAME.fullmatch(name) or name == "stage":
        raise InputError(
            f"{name!r} is no name for a measurement; take letters, digits, - and _, such as bow."
        )
    return project.root / "measure" / f"{name}.{suffix}"


def save_measurement(project: Project, name: str, measured: Measurement) -> Path:
    """Write a measurement, and what it was taken from.

    Raises:
        InputError: The name is none for a file, or a number is not finite.
        DeviceError: The disk is full or cannot be written.
    """
    path = measure_file(project, name)
    quantities = {_key(quantity): as_plain(quantity) for quantity in measured.quantities}
    content = {
        "format": 1,
        "kind": measured.kind,
        "murkscan": version("murkscan"),
        "inputs": {"cloud": project.finished(CLOUD).digest},
        "quantities": quantities,
        "details": dict(measured.details),
    }
    save_json(path, content)
    return path


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
