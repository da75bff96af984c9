"""How far a job is, and how it is stopped: every long job is told one `Progress`."""

import threading
from collections.abc import Callable

from ..errors import Cancelled

Progress = Callable[[str, int, int | None], None]
"""Told the stage's word, how many steps are done, and of how many (None: nobody knows).

What it raises ends the job at that step; what is finished is kept, and the same job goes on there.
"""


def silent(stage: str, done: int, total: int | None) -> None:
    """Tell nobody."""


class Stoppable:
    """A `Progress` that another thread may stop, such as that of a web page."""

    def __init__(self, show: Progress = silent) -> None:
        self._show, self._is_stopped = show, threading.Event()

    def stop(self) -> None:
        """End the job at its next step."""
        self._is_stopped.set()

    def __call__(self, stage: str, done: int, total: int | None) -> None:
        """Show how far the job is.

        Raises:
            Cancelled: It has been stopped.
        """
        if self._is_stopped.is_set():
            raise Cancelled(f"stopped in {stage}; what is finished is kept. Run it again to go on.")
        self._show(stage, done, total)
