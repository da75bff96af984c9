"""Results in order while only a few tasks are under way."""

from collections import deque
from collections.abc import Callable, Generator, Iterable
from concurrent.futures import Future
from typing import TypeVar

T = TypeVar("T")
R = TypeVar("R")


def map_in_window(
    submit: Callable[[T], Future[R]], items: Iterable[T], width: int
) -> Generator[R, None, None]:
    """Submit items as results are taken, and take the next one while the others are worked on.

    Args:
        submit: Begins the work on an item.
        items: What is worked on; one is taken ahead of those under way.
        width: Items under way at once.

    Yields:
        The results in the order of the items.
    """
    waiting: deque[Future[R]] = deque()
    try:
        for item in items:
            if len(waiting) < width:
                waiting.append(submit(item))
                continue
            result = waiting.popleft().result()
            waiting.append(submit(item))
            yield result
        while waiting:
            yield waiting.popleft().result()
    finally:
        for future in waiting:
            future.cancel()
