"""One item after another."""

from collections.abc import Callable, Generator, Iterable
from dataclasses import dataclass
from typing import ClassVar, TypeVar, final

from .base import AbstractExecutor

T = TypeVar("T")
R = TypeVar("R")


@final
@dataclass(frozen=True)
class Serial(AbstractExecutor):
    """Work in the thread that asks."""

    shares_memory: ClassVar[bool] = True

    def map(self, task: Callable[[T], R], items: Iterable[T]) -> Generator[R, None, None]:
        """Run a task for each item; see `AbstractExecutor.map`."""
        yield from map(task, items)
