"""Several frames at once: compiled loops let others run while they compute."""

import os
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

_MOST = 4
"""Threads: each holds a few pictures of its own."""

Item = TypeVar("Item")
Result = TypeVar("Result")


def map_at_once(work: Callable[[Item], Result], items: Iterable[Item]) -> list[Result]:
    """Do the same with each item, and give the results in order."""
    with ThreadPoolExecutor(min(os.cpu_count() or 1, _MOST)) as pool:
        return list(pool.map(work, items))
