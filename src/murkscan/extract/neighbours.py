"""Frames with those before and after them."""

from collections import deque
from collections.abc import Iterable, Iterator, Mapping
from typing import Protocol, TypeVar, runtime_checkable


@runtime_checkable
class Numbered(Protocol):
    """Something of one frame."""

    @property
    def index(self) -> int:
        """Number of the frame in its recording."""
        ...


Item = TypeVar("Item", bound=Numbered)


def with_neighbours(items: Iterable[Item], reach: int) -> Iterator[Mapping[int, Item]]:
    """Give each item together with those up to `reach` frames before and after it.

    The keys are distances in frames; 0 is the item itself. Frames that could not be read are
    missing. No more than `2 · reach + 1` items are held at once.
    """
    held: deque[Item] = deque()
    waiting: deque[Item] = deque()
    for item in items:
        held.append(item)
        waiting.append(item)
        while waiting and waiting[0].index + reach <= item.index:
            yield _around(waiting.popleft(), held, reach)
        first = waiting[0].index if waiting else item.index + 1
        while held and held[0].index < first - reach:
            held.popleft()
    while waiting:
        yield _around(waiting.popleft(), held, reach)


def _around(item: Item, held: Iterable[Item], reach: int) -> dict[int, Item]:
    distances = ((other.index - item.index, other) for other in held)
    return {distance: other for distance, other in distances if abs(distance) <= reach}
