"""Tables of numbers as loggers and spreadsheets write them."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ..errors import FormatError

_LEADS = "#%/ \t"
"""What may stand before the names of the columns."""
_NUMBER = re.compile(r"[-+]?(\d+[.,]?\d*|[.,]\d+)([eE][-+]?\d+)?|[-+]?(nan|inf|infinity)", re.I)
_CLOCK = re.compile(r"\d{4}[-/]\d\d[-/]\d\d|\d{1,2}:\d\d")
"""How a date or a time of day begins."""


@dataclass(frozen=True)
class TextTable:
    """Cells of a text file, each row with the number of its line."""

    names: tuple[str, ...]
    """Names of the columns as they stand; none where the first line holds numbers."""
    rows: Sequence[tuple[str, ...]]
    """Cells without the blanks round them, decimal commas made points."""
    lines: Sequence[int]
    """Number of each row's line in the file, from 1."""


def read_text_table(path: Path, what: str) -> TextTable:
    """Read columns parted by commas, semicolons, tabs or blanks.

    The names of the columns may stand in the first line, also behind # or %. Other lines that
    begin with # are comments. Between semicolons or tabs a comma is the decimal sign, as
    spreadsheets have it in much of Europe.

    Args:
        path: The file, in UTF-8, UTF-16 or Latin-1.
        what: What errors call it, such as "pose log".

    Raises:
        FormatError: The file cannot be read, or is no text.
    """
    return parse_text_table(_read_lines(path, what))


def parse_text_table(lines: Sequence[str], *, first: int = 1) -> TextTable:
    """Make a table of lines; see `read_text_table`.

    Args:
        lines: The lines.
        first: Number of the first of them in its file.
    """
    numbered = [(k, line.strip()) for k, line in enumerate(lines, start=first)]
    numbered = [(k, line) for k, line in numbered if line.strip(_LEADS)]
    names: tuple[str, ...] = ()
    separator: str | None = None
    if numbered:
        separator = _separator(numbered[0][1])
        names = _names(numbered[0][1], separator)
        numbered = numbered[1:] if names else numbered
    numbered = [(k, line) for k, line in numbered if line[0] not in "#%"]
    if numbered and not names:
        separator = _separator(numbered[0][1])
    swaps = separator in (";", "\t")
    rows = [
        tuple(
            cell.strip().strip('"').replace(",", "." if swaps else ",")
            for cell in line.split(separator)
        )
        for _, line in numbered
    ]
    return TextTable(names, rows, [k for k, _ in numbered])


def _read_lines(path: Path, what: str) -> list[str]:
    try:
        data = path.read_bytes()
    except OSError as error:
        raise FormatError(f"The {what} {path} cannot be read: {error.strerror}.") from error
    wide = data.startswith((b"\xff\xfe", b"\xfe\xff"))
    for encoding in ("utf-16",) if wide else ("utf-8-sig", "latin-1"):
        try:
            text = data.decode(encoding)
        except UnicodeDecodeError:
            continue
        if "\0" not in text:
            return text.splitlines()
    raise FormatError(f"The {what} {path} cannot be read: it is no text.")


def _separator(line: str) -> str | None:
    """Find what parts the cells; None for blanks."""
    return next((sign for sign in (";", "\t", ",") if sign in line), None)


def _names(line: str, separator: str | None) -> tuple[str, ...]:
    """Give the names of the columns; none where the line holds numbers or times."""
    cells = [cell.strip().strip('"') for cell in line.lstrip(_LEADS).split(separator)]
    is_data = any(_NUMBER.fullmatch(cell) or _CLOCK.match(cell) for cell in cells)
    is_remark = line[0] in "#%" and len(cells) < 3
    return () if is_data or is_remark else tuple(cells)
