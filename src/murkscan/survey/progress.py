"""How far a job is."""

from collections.abc import Callable

Progress = Callable[[str, int, int | None], None]
"""Told the stage's word, how many steps are done, and of how many (None: nobody knows)."""


def silent(stage: str, done: int, total: int | None) -> None:
    """Tell nobody."""
