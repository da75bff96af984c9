"""How a text file of points is laid out: what parts its columns, and what they are called."""

import re
from collections.abc import Sequence
from dataclasses import dataclass

from .cloud_columns import known_name

COMMENTS = ("#", "//")
"""What lines begin with that hold no points."""
HEAD = 20
"""Lines that are looked at."""

_DECIMAL_COMMA = re.compile(r"[-+]?\d+(,\d+)?([eE][-+]?\d+)?")
_SEPARATORS = re.compile(r"[,;\t]")
_COMMON = {"coord._x": "x", "coord._y": "y", "coord._z": "z"}
"""What CloudCompare calls the coordinates in a CSV."""


@dataclass(frozen=True)
class TextLayout:
    """What is known of a file from its first lines."""

    names: tuple[str, ...] = ()
    """Names of the columns; none where the file gives none."""
    num_skipped: int = 0
    """Lines before the first point: the names, and the number of points."""
    has_decimal_commas: bool = False
    """Whether the comma is the decimal sign, as spreadsheets have it in much of Europe."""

    def as_numbers(self, line: str) -> str:
        """Give a line with blanks between its numbers, and points in them."""
        if self.has_decimal_commas:
            line = line.replace(",", ".")
        return _SEPARATORS.sub(" ", line)


def find_layout(head: Sequence[str]) -> TextLayout:
    """Look at the first lines of a file that are not empty.

    The first may name the columns, also after # or //; where commas, semicolons or tabs part them,
    names may hold blanks. One number alone on its line before the points is their count.

    Args:
        head: The lines, up to `HEAD`.
    """
    names = _names(head[0]) if head else ()
    skipped = 1 if names else 0
    while skipped < len(head) and head[skipped].startswith(COMMENTS):
        skipped += 1
    if _is_count(head[skipped : skipped + 2]):
        skipped += 1
    first = head[skipped] if skipped < len(head) else ""
    has_commas = _has_decimal_commas(first)
    width = len(TextLayout(has_decimal_commas=has_commas).as_numbers(first).split())
    return TextLayout(_fit(names, width), skipped, has_commas)


def _is_count(lines: Sequence[str]) -> bool:
    """Tell whether the first of two lines is one number, and the second several."""
    return len(lines) == 2 and lines[0].strip().isdecimal() and len(_split(lines[1])) > 1


def _names(line: str) -> tuple[str, ...]:
    """Give the names of the columns; none where the line holds none that is known."""
    words = [_clean(word) for word in _split(line.lstrip("#/ "))]
    return tuple(words) if any(known_name(word) for word in words) else ()


def _clean(word: str) -> str:
    name = re.sub(r"\s+", "_", word.strip().strip('"').lower())
    return _COMMON.get(name, name)


def _split(line: str) -> list[str]:
    """Part a line by the first of semicolon, tab and comma that it has, else by blanks."""
    return line.split(next((sign for sign in ";\t," if sign in line), None))


def _fit(names: tuple[str, ...], width: int) -> tuple[str, ...]:
    """Keep of names that blanks have broken apart those that are surely in their place: x, y, z."""
    if len(names) > width >= 3 and names[:3] == ("x", "y", "z"):
        return (*names[:3], *[""] * (width - 3))
    return names


def _has_decimal_commas(line: str) -> bool:
    sign = next((sign for sign in ";\t" if sign in line), None)
    cells = [cell.strip() for cell in line.split(sign)]
    return (
        len(cells) >= 3
        and any("," in cell for cell in cells)
        and all(_DECIMAL_COMMA.fullmatch(cell) for cell in cells)
    )
