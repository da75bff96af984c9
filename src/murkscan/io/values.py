"""Frozen dataclasses as plain values for JSON, and back: results, notes, and what was learnt.

An array becomes its type, its shape and its bytes, so that it comes back as it was.
"""

import base64
import dataclasses
import math
import types
import typing
import zlib
from collections.abc import Mapping
from datetime import datetime
from pathlib import Path
from typing import Any, TypeVar, cast

import numpy as np

from ..errors import FormatError
from .json_files import load_json, save_json

T = TypeVar("T")


def save_value(path: Path, value: Any) -> None:
    """Write a dataclass.

    Raises:
        InputError: A number is not finite.
        DeviceError: The disk is full or cannot be written.
    """
    save_json(path, as_plain(value))


def load_value(path: Path, kind: type[T]) -> T:
    """Read what `save_value` wrote.

    Raises:
        FormatError: The file is no JSON, or holds something else.
    """
    return from_plain(kind, load_json(path), name=str(path))


def as_plain(value: Any) -> Any:
    """Turn a dataclass, or a value in one, into dictionaries, lists, texts and numbers.

    A field with a `unit` in its metadata carries that unit in its key.
    """
    if dataclasses.is_dataclass(value):
        return {_key(f): as_plain(getattr(value, f.name)) for f in dataclasses.fields(value)}
    if isinstance(value, np.ndarray):
        data = zlib.compress(np.ascontiguousarray(value).tobytes(), 1)
        text = base64.b64encode(data).decode("ascii")
        return {"dtype": value.dtype.str, "shape": list(value.shape), "zlib": text}
    if isinstance(value, Mapping):
        return {name: as_plain(item) for name, item in value.items()}
    if isinstance(value, tuple | list):
        return [as_plain(item) for item in value]
    if isinstance(value, datetime):
        return value.isoformat(timespec="seconds")
    if isinstance(value, np.generic):
        return value.item()
    return value


def from_plain(kind: type[T], plain: Any, *, name: str) -> T:
    """Make a dataclass of what `as_plain` gave; unknown keys are of a later version and left out.

    Args:
        kind: The dataclass.
        plain: The plain values.
        name: Where they stand, for messages.

    Raises:
        FormatError: A key is missing, or its value is of another type.
    """
    try:
        return cast(T, _read(kind, plain, ""))
    except (
        _Odd,
        ValueError,
        TypeError,
        KeyError,
        AttributeError,
        OverflowError,
        zlib.error,
    ) as error:
        where = f"{error}" if isinstance(error, _Odd) else "a value that makes no sense"
        raise FormatError(f"{name} is damaged: it has {where}. Delete it and run again.") from error


class _Odd(Exception):
    """A value that is not of its type, in words."""


def _key(field: "dataclasses.Field[Any]") -> str:
    unit = field.metadata.get("unit")
    return f"{field.name}_{unit}" if unit else field.name


def _read(kind: Any, plain: Any, where: str) -> Any:
    """Read one value of a type; `where` is the key that it stands at."""
    origin, inside = typing.get_origin(kind), typing.get_args(kind)
    if kind is Any:
        return plain
    if origin in (types.UnionType, typing.Union):
        return None if plain is None else _read(_not_none(inside), plain, where)
    if origin is typing.Literal:
        return _require_one_of(inside, plain, where)
    if origin is typing.Annotated:
        return _read(inside[0], plain, where)
    if dataclasses.is_dataclass(kind):
        return _read_fields(kind, _require(dict, plain, where), where)
    if getattr(kind, "array_type", kind) is np.ndarray:
        return _read_array(kind, _require(dict, plain, where), where)
    if origin is tuple:
        return _read_tuple(inside, _require(list, plain, where), where)
    if origin in (dict, Mapping):
        items = _require(dict, plain, where).items()
        return {key: _read(inside[1], item, f"{where}.{key}") for key, item in items}
    if kind is datetime:
        return datetime.fromisoformat(_require(str, plain, where))
    if kind is float:
        return float(_require((int, float), plain, where))
    return _require(origin or kind, plain, where)


def _read_fields(kind: Any, plain: dict[str, Any], where: str) -> Any:
    hints, values = typing.get_type_hints(kind), {}
    for field in dataclasses.fields(kind):
        key = _key(field)
        if key in plain:
            at = f"{where}.{key}".lstrip(".")
            values[field.name] = _read(hints[field.name], plain[key], at)
        elif _has_no_default(field):
            raise _Odd(f"no {f'{where}.{key}'.lstrip('.')}")
    return kind(**values)


def _read_tuple(inside: tuple[Any, ...], plain: list[Any], where: str) -> tuple[Any, ...]:
    if inside[1:] == (...,):
        inside = inside[:1] * len(plain)
    if len(inside) != len(plain):
        raise _Odd(f"{len(plain)} values at {where} in place of {len(inside)}")
    return tuple(_read(one, item, where) for one, item in zip(inside, plain, strict=True))


def _read_array(kind: Any, plain: dict[str, Any], where: str) -> np.ndarray:
    dtype, shape = np.dtype(plain["dtype"]), tuple(map(int, plain["shape"]))
    packed = base64.b64decode(plain["zlib"], validate=True)
    # No more is unpacked than the array takes, whatever a damaged file says.
    data = zlib.decompressobj().decompress(packed, max(math.prod(shape) * dtype.itemsize, 1))
    array = np.frombuffer(data, dtype).reshape(shape).copy()
    if not isinstance(array, kind):
        raise _Odd(f"an array of {array.dtype} {array.shape} at {where}")
    return array


def _require(kind: Any, plain: Any, where: str) -> Any:
    # JSON's true is no number, although Python's is.
    if not isinstance(plain, kind) or (isinstance(plain, bool) and kind is not bool):
        raise _Odd(f"{str(plain)[:40]!r} at {where or 'its top'}")
    return plain


def _require_one_of(words: tuple[Any, ...], plain: Any, where: str) -> Any:
    if plain not in words:
        raise _Odd(f"{str(plain)[:40]!r} at {where}, which is none of {', '.join(map(str, words))}")
    return plain


def _not_none(inside: tuple[Any, ...]) -> Any:
    (kind,) = (one for one in inside if one is not types.NoneType)
    return kind


def _has_no_default(field: "dataclasses.Field[Any]") -> bool:
    missing = dataclasses.MISSING
    return field.default is missing and field.default_factory is missing
