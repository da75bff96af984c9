"""The names that scene.toml knows shapes and textures by, and what may be set of them."""

import math
from collections.abc import Mapping
from dataclasses import fields
from typing import Any, get_type_hints

from pydantic import TypeAdapter, ValidationError

from ..errors import InputError
from .shapes import Chessboard, Cylinder, Grown, Hull, Plane, SheetPile, Sphere, Stairs
from .textures import Bands, Checkered, Growth, Plain

SHAPES: dict[str, type] = {
    "chessboard": Chessboard,
    "cylinder": Cylinder,
    "grown": Grown,
    "hull": Hull,
    "plane": Plane,
    "sheet_pile": SheetPile,
    "sphere": Sphere,
    "stairs": Stairs,
}
"""Built-in objects."""
TEXTURES: dict[str, type] = {
    "plain": Plain,
    "bands": Bands,
    "growth": Growth,
    "checkered": Checkered,
}
"""Ways in which a surface may be painted."""
_LENGTHS = {"width", "height", "widths", "heights", "radius", "length", "beam", "draft", "tread",
            "square", "size", "rib", "depth", "bulge", "bulge_width", "bump"}  # fmt: skip
"""Fields that are lengths: their keys carry the unit."""
_RENAMED = {"share": "albedo"}
"""Fields whose keys have the name that people look for."""


def make_choice(choices: Mapping[str, type], name: str, settings: dict[str, Any], key: str) -> Any:
    """Make what a name stands for, with its settings; a length is given in `<field>_mm`.

    Raises:
        InputError: The name or a setting is unknown, or a setting is out of range.
    """
    if name not in choices:
        raise InputError(f"{key} must be one of {', '.join(choices)}, got {name!r}.")
    keys = {_key_of(field.name): field.name for field in fields(choices[name])}
    hints = get_type_hints(choices[name])
    values = {}
    for setting, value in settings.items():
        where = f"{key.rpartition('.')[0]}.{setting}"
        if setting not in keys:
            raise InputError(f"{where} is no key of the {name}; it knows {', '.join(keys)}.")
        read = _read(hints[keys[setting]], value, where)
        values[keys[setting]] = _scale(read, 1e-3) if setting.endswith("_mm") else read
    try:
        return choices[name](**values)
    except InputError as error:
        text = str(error)
        for field, shown in _RENAMED.items():
            text = text.replace(f"{field} =", f"{shown} =")
        raise InputError(f"{key} {name}: {text}") from error


def _key_of(field: str) -> str:
    return f"{field}_mm" if field in _LENGTHS else _RENAMED.get(field, field)


def _read(hint: Any, value: Any, key: str) -> Any:
    """Read a value as the field's type wants it."""
    try:
        read = TypeAdapter(hint).validate_python(value)
    except ValidationError as error:
        wrong = error.errors(include_url=False)[0]["msg"].lower()
        raise InputError(f"{key}: {wrong}, got {value!r}.") from error
    if isinstance(read, float) and not math.isfinite(read):
        raise InputError(f"{key} must be a finite number, got {value!r}.")
    return read


def _scale(value: Any, scale: float) -> Any:
    """Give lengths in metres."""
    return tuple(v * scale for v in value) if isinstance(value, tuple) else value * scale
