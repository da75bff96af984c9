"""Several processes of this machine."""

import multiprocessing
import os
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from dataclasses import dataclass
from itertools import count
from typing import ClassVar, TypeVar, final

from ..errors import DeviceError
from .base import AbstractExecutor, check_workers

T = TypeVar("T")
R = TypeVar("R")
_DEATHS = 3
"""How often workers may die in one job before it is given up: a task that kills them would kill
all."""


@final
@dataclass(frozen=True)
class Processes(AbstractExecutor):
    """Work in processes of their own; one that dies costs the tasks that were under way."""

    workers: int | None = None
    """How many; as many as there are cores unless said."""
    niceness: int = 0
    """How much they give way to others, 0 to 19; only where the system knows it."""

    shares_memory: ClassVar[bool] = False

    def __post_init__(self) -> None:
        """Refuse a number that does no work."""
        check_workers(self.workers)

    def map(self, task: Callable[[T], R], items: Iterable[T]) -> Generator[R, None, None]:
        """Run a task for each item; see `AbstractExecutor.map`."""
        workers = self.workers or os.cpu_count() or 1
        source, waiting, deaths = iter(items), list[T](), count(1)
        while True:
            # A forked process would inherit locks of threads that it has not.
            context = multiprocessing.get_context("spawn")
            with ProcessPoolExecutor(
                workers, context, initializer=give_way, initargs=(self.niceness,)
            ) as pool:
                try:
                    yield from _work(pool, task, source, waiting, workers + 1)
                    return
                except BrokenProcessPool as error:
                    if next(deaths) >= _DEATHS:
                        raise DeviceError(
                            f"Worker processes died {_DEATHS} times; what is finished is kept. If "
                            "memory was short, give fewer with --workers."
                        ) from error
                finally:
                    pool.shutdown(wait=True, cancel_futures=True)


def give_way(niceness: int) -> None:
    """Make the process that calls give way to others; on Linux the thread, and what it starts.

    Args:
        niceness: By how much more than so far, to 19 at most.
    """
    with suppress(OSError, AttributeError):
        os.nice(niceness)


def _work(
    pool: ProcessPoolExecutor,
    task: Callable[[T], R],
    source: Iterator[T],
    waiting: list[T],
    width: int,
) -> Generator[R, None, None]:
    """Work on what waits, and then on what the source gives; what is not done keeps waiting."""
    futures: list[Future[R]] = [pool.submit(task, item) for item in waiting]
    while True:
        while len(futures) < width:
            try:
                item = next(source)
            except StopIteration:
                break
            waiting.append(item)
            futures.append(pool.submit(task, item))
        if not futures:
            return
        result = futures[0].result()
        del futures[0], waiting[0]
        yield result
