"""What commands print: sentences behind a word, and tables, as wide as the terminal."""

import shutil
import sys
import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from rich.console import Console

_INDENT = 11
"""Columns of the word before the sentences."""
_PIPED = 160
"""Width of tables that no terminal shows."""


def tell(word: str, *lines: str, indent: int = _INDENT) -> None:
    """Print lines behind a word that says what they are about; a path is never broken.

    What is read by another program is not wrapped.
    """
    for number, line in enumerate(lines):
        _print(f"{word if number == 0 else '':<{indent - 1}} {line}", indent)


def say(sentence: str) -> None:
    """Print a sentence as it is: brackets in it mean nothing."""
    _print(sentence, 0)


def say_verdict(verdict: str, is_good: bool, *, is_usable: bool = True) -> None:
    """Print a verdict in its colour."""
    from rich.text import Text

    style = f"bold {'green' if is_good else 'yellow' if is_usable else 'red'}"
    _console().print(Text(verdict, style=style), soft_wrap=not sys.stdout.isatty())


def print_table(title: str, columns: tuple[str, ...], rows: list[tuple[str, ...]]) -> None:
    """Print a table; all columns but the first are numbers.

    No number is ever cut: where the terminal is too narrow for a table, rows are told as lists.
    """
    from rich.markup import escape
    from rich.table import Table

    console = _console()
    widths = fit_columns([columns, *rows], console.width)
    if widths is None:
        _print_lists(title, columns, rows)
        return
    table = Table(title=title, title_justify="left")
    for column, width in zip(columns, widths, strict=True):
        justify: Literal["left", "right"] = "left" if column == columns[0] else "right"
        table.add_column(escape(column), justify=justify, width=width)
    for row in rows:
        table.add_row(*map(escape, row))
    console.print(table)


def fit_columns(rows: Sequence[tuple[str, ...]], width: int) -> list[int] | None:
    """Divide a terminal's width among the columns of a table, so that no word is cut.

    Args:
        rows: What stands in each row, that of the titles among them.
        width: Columns of the terminal.

    Returns:
        Columns of each of the table's columns; None where their longest words have no room.
    """
    cells = list(zip(*rows, strict=True))
    widths = [max((len(word) for text in one for word in text.split()), default=0) for one in cells]
    wanted = [max(map(len, one)) for one in cells]
    spare = width - sum(widths) - 3 * len(cells) - 1  # a line and two spaces beside each column
    if spare < 0:
        return None
    for place in sorted(range(len(cells)), key=lambda place: wanted[place] - widths[place]):
        more = min(wanted[place] - widths[place], spare)
        widths[place] += more
        spare -= more
    return widths


def _print_lists(title: str, columns: tuple[str, ...], rows: list[tuple[str, ...]]) -> None:
    if title:
        say(title)
    indent = max(map(len, columns)) + 2
    for row in rows:
        say(" ".join(filter(None, (columns[0], row[0]))))
        for column, text in zip(columns[1:], row[1:], strict=True):
            if text:
                tell(f"  {column}", text, indent=indent + 1)


def wrap(text: str, width: int, *, indent: int = 0) -> str:
    """Break a line between words, never within a path; later lines are indented."""
    return textwrap.fill(
        text,
        width,
        subsequent_indent=" " * indent,
        break_long_words=False,
        break_on_hyphens=False,
        drop_whitespace=True,
    )


def _print(line: str, indent: int) -> None:
    if sys.stdout.isatty():
        line = wrap(line, shutil.get_terminal_size().columns, indent=indent)
    print(line)


def _console() -> "Console":
    from rich.console import Console

    return Console(width=None if sys.stdout.isatty() else _PIPED, highlight=False)
