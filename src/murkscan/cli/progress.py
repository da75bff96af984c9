"""Progress bars on the terminal, from the first moment on."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from ..ui.progress_lines import ASK, ProgressLines

if TYPE_CHECKING:
    from rich.progress import Progress as Bars

    from ..survey.progress import Progress

_COMPILING = "making its loops fast, once on this machine: some 20 s in all where nothing else runs"


@contextmanager
def progress_bars() -> Iterator["Progress"]:
    """Show a bar for each stage that tells how far it is, and what goes on before the first.

    What is loaded within it is loaded while something is on the screen. A program that runs the
    command may ask for lines instead.
    """
    if os.environ.get(ASK) == "lines":
        yield ProgressLines()
        return
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        ProgressColumn,
        SpinnerColumn,
        TaskID,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )
    from rich.progress import Progress as Bars

    name = TextColumn("{task.description:<22}")
    columns: list[ProgressColumn] = [SpinnerColumn(), name, BarColumn()]
    columns += [MofNCompleteColumn(), TimeElapsedColumn(), TimeRemainingColumn()]
    tasks: dict[str, TaskID] = {}
    with Bars(*columns, console=Console(stderr=True)) as bars:
        loading = bars.add_task("loading", total=None)

        def show(stage: str, done: int, total: int | None) -> None:
            bars.update(loading, visible=False)
            if stage not in tasks:
                tasks[stage] = bars.add_task(stage, total=total)
            bars.update(tasks[stage], completed=min(done, total or done), total=total)

        try:
            with _telling_of_compilation(bars):
                yield show
        finally:
            bars.update(loading, visible=False)
        for task in bars.tasks:
            if task.total is None:  # nobody knew how many steps there would be; now it is known
                bars.update(task.id, total=max(task.completed, 1), completed=max(task.completed, 1))


@contextmanager
def working(what: str) -> Iterator[None]:
    """Show that something goes on of which nobody knows how long it takes."""
    if os.environ.get(ASK) == "lines":
        yield
        return
    from rich.console import Console

    with Console(stderr=True).status(what):
        yield


@contextmanager
def _telling_of_compilation(bars: "Bars") -> Iterator[None]:
    """Say so when loops are compiled, as they are on their first use after an installation."""
    from numba.core import event

    told = False

    class Listener(event.Listener):  # type: ignore[misc]
        def on_start(self, event: object) -> None:
            nonlocal told
            if not told:
                told = True
                bars.console.print(_COMPILING, highlight=False)

        def on_end(self, event: object) -> None:
            pass

    with event.install_listener("numba:compile", Listener()):
        yield
