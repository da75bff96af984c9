"""Values in one line, for whoever prints them."""

from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

_WIDTH = 99
"""Letters of a line."""
_SHOWN = 4
"""Numbers of an array that are written out, at most."""


class ShortRepr:
    """Dataclasses with arrays, whose shapes are written and not their numbers."""

    def __repr__(self) -> str:
        """Write the value in one line; fields without a value are left out."""
        said = [(f.name, _shorten(getattr(self, f.name))) for f in fields(self)]  # type: ignore[arg-type]
        return cut_line(type(self).__name__, [f"{name}={text}" for name, text in said if text])


def cut_line(name: str, parts: list[str]) -> str:
    """Write a value's name and its parts, as many as a line holds."""
    line = f"{name}({', '.join(parts)})"
    return line if len(line) <= _WIDTH else f"{line[: _WIDTH - 2]}…)"


def _shorten(value: Any) -> str:
    if isinstance(value, np.ndarray):
        if value.size <= _SHOWN and value.dtype.kind in "fiub":
            return f"[{', '.join(f'{number:g}' for number in value.ravel().tolist())}]"
        return "×".join(map(str, value.shape))
    if is_dataclass(value):
        return type(value).__name__
    if isinstance(value, tuple) and any(map(is_dataclass, value)):
        return f"{len(value)} × {type(value[0]).__name__}"
    if isinstance(value, float):
        return f"{value:g}"
    return "" if value is None or value == () else repr(value)
