"""What commands print: sentences behind a word, and tables, as wide as the terminal."""

import shutil
import sys
import textwrap
from typing import TYPE_CHECKING

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
    """Print a table; all columns but the first are numbers."""
    from rich.markup import escape
    from rich.table import Table

    table = Table(title=title, title_justify="left")
    for column in columns:
        table.add_column(escape(column), justify="left" if column == columns[0] else "right")
    for row in rows:
        table.add_row(*map(escape, row))
    _console().print(table)


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
