"""What a result was made with, as plain values: for stage.json, scan.json and the report."""

import dataclasses
import hashlib
import json
from pathlib import Path
from typing import Any

import numpy as np


def describe(value: Any) -> Any:
    """Describe a Choice or a value by plain values that change whenever it changes.

    A dataclass becomes its type and its fields, an array a short digest of its type, its shape
    and its bytes.
    """
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        inside = {f.name: describe(getattr(value, f.name)) for f in dataclasses.fields(value)}
        return {"type": type(value).__name__, **inside}
    if isinstance(value, np.ndarray):
        head = f"{value.dtype.str} {value.shape} ".encode("ascii")
        return "array " + hashlib.sha256(head + value.tobytes()).hexdigest()[:16]
    if isinstance(value, Path):
        return str(value)
    if isinstance(value, tuple | list):
        return [describe(item) for item in value]
    return value


def digest(plain: Any) -> str:
    """Compute a short text that changes with plain values."""
    return hashlib.sha256(json.dumps(plain, sort_keys=True).encode()).hexdigest()[:16]
