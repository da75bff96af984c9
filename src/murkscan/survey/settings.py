"""What a result was made with, as plain values: for stage.json, scan.json and the report."""

import dataclasses
import hashlib
from pathlib import Path
from typing import Any

import numpy as np


def describe(value: Any) -> Any:
    """Give a Choice or a value as plain values that change whenever it changes.

    A dataclass becomes its type and its fields, an array a short digest of its bytes.
    """
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        inside = {f.name: describe(getattr(value, f.name)) for f in dataclasses.fields(value)}
        return {"type": type(value).__name__, **inside}
    if isinstance(value, np.ndarray):
        return "array " + hashlib.sha256(value.tobytes()).hexdigest()[:16]
    if isinstance(value, Path):
        return str(value)
    if isinstance(value, tuple | list):
        return [describe(item) for item in value]
    return value
