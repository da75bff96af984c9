"""What calibrations say in the terminal."""


def say(words: str) -> None:
    """Print words as they are: brackets in them mean nothing."""
    from rich import print as show
    from rich.markup import escape

    show(escape(words))


def say_verdict(verdict: str, is_good: bool) -> None:
    """Print a verdict in its colour."""
    from rich import print as show
    from rich.markup import escape

    show(f"[bold {'green' if is_good else 'yellow'}]{escape(verdict)}[/]")


def print_table(title: str, columns: tuple[str, ...], rows: list[tuple[str, ...]]) -> None:
    """Print a table; all columns but the first are numbers."""
    from rich import print as show
    from rich.markup import escape
    from rich.table import Table

    table = Table(title=title, title_justify="left")
    for column in columns:
        table.add_column(escape(column), justify="left" if column == columns[0] else "right")
    for row in rows:
        table.add_row(*row)
    show(table)
