"""What every executor can do."""

import abc
from collections.abc import Callable, Generator, Iterable
from typing import ClassVar, TypeVar

from ..errors import InputError

T = TypeVar("T")
R = TypeVar("R")


class AbstractExecutor(abc.ABC):
    """A way to run a task for many items. Subclasses are final: wrap one, do not subclass it."""

    shares_memory: ClassVar[bool]
    """Whether items and results stay where they are, so that large ones cost nothing to pass on."""

    @abc.abstractmethod
    def map(self, task: Callable[[T], R], items: Iterable[T]) -> Generator[R, None, None]:
        """Run a task for each item.

        Items are taken as they are needed, and few results wait: memory stays bounded however many
        there are. Closing the iterator ends the work.

        Args:
            task: What is done; where memory is not shared, it can be pickled, and may be done
                again if a worker dies.
            items: What it is done for; likewise.

        Yields:
            The results in the order of the items.

        Raises:
            DeviceError: Workers cannot be reached, or die again and again.
        """


def check_workers(workers: int | None) -> None:
    """Refuse a number of workers that does no work.

    Raises:
        InputError: It is below 1.
    """
    if workers is not None and workers < 1:
        raise InputError(f"There must be at least 1 worker, got {workers}.")
