"""The names that scene.toml knows shapes and textures by, and what may be set of them."""

import math
from collections.abc import Mapping
from dataclasses import fields
from typing import Any

from ..errors import InputError
from .shapes import Chessboard, Cylinder, Hull, Plane, Sphere, Stairs
from .textures import Bands, Checkered, Growth, Plain

SHAPES: dict[str, type] = {
    "chessboard": Chessboard,
    "cylinder": Cylinder,
    "hull": Hull,
    "plane": Plane,
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
            "square", "size"}  # fmt: skip
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
    values = {}
    for setting, value in settings.items():
        if setting not in keys:
            raise InputError(
                f"{key.rpartition('.')[0]}.{setting} is no key of the {name}; it knows "
                f"{', '.join(keys)}."
            )
        scale = 1e-3 if setting.endswith("_mm") else 1.0
        values[keys[setting]] = _as_value(value, scale, f"{key.rpartition('.')[0]}.{setting}")
    try:
        return choices[name](**values)
    except InputError as error:
        raise InputError(f"{key} {name}: {error}") from error


def _key_of(field: str) -> str:
    return f"{field}_mm" if field in _LENGTHS else _RENAMED.get(field, field)


def _as_value(value: Any, scale: float, key: str) -> Any:
    """Give a setting in SI; lists become tuples."""
    if isinstance(value, list):
        return tuple(_as_value(item, scale, key) for item in value)
    if scale == 1.0 and isinstance(value, str | int) and not isinstance(value, bool):
        return value
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise InputError(f"{key} must be a number, got {value!r}.")
    return value * scale
