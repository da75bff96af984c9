"""How much of a file is read at once: points of many columns, and long lines, are fewer."""

from collections.abc import Iterator
from typing import TypeVar

from .cloud_columns import BLOCK

_MOST_BYTES = 1 << 25
_MOST_TEXT = _MOST_BYTES // 4
"""Every second byte of a text may be a number, of eight bytes."""

Line = TypeVar("Line", str, bytes)


def rows_at_once(size: int, block: int = BLOCK) -> int:
    """Give how many rows of a size [bytes] are read at once: a block, at most, and at least one."""
    return max(min(block, _MOST_BYTES // max(size, 1)), 1)


def lines_at_once(lines: Iterator[Line], block: int = BLOCK) -> list[Line]:
    """Take a block of lines, or fewer where they are long; none at the end."""
    some, size = list[Line](), 0
    for line in lines:
        some.append(line)
        size += len(line)
        if len(some) == block or size >= _MOST_TEXT:
            break
    return some
