"""Several threads of this process: kernels let others run while they compute."""

import os
from collections.abc import Callable, Generator, Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import ClassVar, TypeVar, final

from .base import AbstractExecutor, check_workers
from .window import map_in_window

T = TypeVar("T")
R = TypeVar("R")
_MOST = 4
"""Threads unless said: reading, in one thread, is what limits more."""


@final
@dataclass(frozen=True)
class Threads(AbstractExecutor):
    """Work in threads, while the thread that asks gets the items."""

    workers: int | None = None
    """How many; as many as there are cores, up to four, unless said."""

    shares_memory: ClassVar[bool] = True

    def __post_init__(self) -> None:
        """Refuse a number that does no work."""
        check_workers(self.workers)

    def map(self, task: Callable[[T], R], items: Iterable[T]) -> Generator[R, None, None]:
        """Run a task for each item; see `AbstractExecutor.map`."""
        workers = self.workers or min(os.cpu_count() or 1, _MOST)
        with ThreadPoolExecutor(workers) as pool:
            yield from map_in_window(lambda item: pool.submit(task, item), items, workers)
