"""Values of columns: one row a centre, or a point."""

from collections.abc import Sequence
from dataclasses import fields
from typing import Any, TypeVar

import numpy as np

from ..errors import InputError
from .arrays import Indices, Mask
from .short_repr import ShortRepr, cut_line

T = TypeVar("T", bound="Table")
_PLAIN = ("float64", "int64")
"""What columns that may be of several types are made to be."""


class Table(ShortRepr):
    """Columns of equal length. Subclasses are frozen dataclasses whose fields are the columns.

    Columns of another type are made to be of their own, if that changes no number but its last
    digits; else they are refused. One whose metadata say so may be left out, and is 0 then.
    """

    def __post_init__(self) -> None:
        """Make the columns be of their type.

        Raises:
            InputError: One cannot be, has another shape, or another length than the first.
        """
        count = -1
        for column in fields(self):  # type: ignore[arg-type]
            label = f"{type(self).__name__}: {column.name}"
            values = _as_column(getattr(self, column.name), column.type, label)
            if len(values) == 0 and column.metadata.get("may_be_left_out"):
                values = np.zeros(count, values.dtype)
            count = len(values) if count < 0 else count
            if len(values) != count:
                raise InputError(f"{label} has {len(values)} rows beside others with {count}.")
            object.__setattr__(self, column.name, values)

    def __len__(self) -> int:
        """Count the rows."""
        return len(getattr(self, fields(self)[0].name))  # type: ignore[arg-type]

    def __getitem__(self: T, which: Mask | Indices | slice) -> T:
        """Pick some of the rows."""
        return type(self)(*(getattr(self, c.name)[which] for c in fields(self)))  # type: ignore[arg-type]

    def __repr__(self) -> str:
        """Write how many rows there are, and of what."""
        names = [column.name for column in fields(self)]  # type: ignore[arg-type]
        return cut_line(type(self).__name__, [f"{len(self):,} rows of {names[0]}", *names[1:]])

    @classmethod
    def empty(cls: type[T]) -> T:
        """Make one without rows."""
        return cls(*(_empty_column(column.type) for column in fields(cls)))  # type: ignore[arg-type]

    @classmethod
    def concatenate(cls: type[T], tables: Sequence[T]) -> T:
        """Put tables one after another; none make one of length 0."""
        parts = [cls.empty(), *tables]
        names = [column.name for column in fields(cls)]  # type: ignore[arg-type]
        return cls(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))


def _empty_column(kind: Any) -> np.ndarray:
    return np.zeros((0, *_width_of(kind)), _dtype_of(kind))


def _width_of(kind: Any) -> tuple[int, ...]:
    return tuple(int(size) for size in kind.dim_str.split()[1:])


def _dtype_of(kind: Any) -> str:
    return next((name for name in _PLAIN if name in kind.dtypes), kind.dtypes[0])


def _as_column(values: Any, kind: Any, label: str) -> np.ndarray:
    column, wanted = np.asarray(values), _width_of(kind)
    if column.ndim == 0 or column.shape[1:] != wanted:
        shape = " × ".join(["n", *map(str, wanted)])
        raise InputError(f"{label} must be an array of {shape}, got one of {column.shape}.")
    if column.dtype.name in kind.dtypes:
        return column
    name = _dtype_of(kind)
    if column.dtype.kind in "fiub":
        with np.errstate(invalid="ignore", over="ignore"):
            cast = column.astype(name)
        if np.dtype(name).kind == "f" or np.array_equal(cast, column):
            return cast
    raise InputError(f"{label} must be of the type {name}, which its {column.dtype} do not fit.")
