"""What one thread hands to another: bounded, so that who comes too fast loses his oldest."""

import threading
from collections import deque
from typing import Generic, TypeVar

T = TypeVar("T")


class Mailbox(Generic[T]):
    """Items for one reader; putting never waits, and when it is full the oldest item goes."""

    def __init__(self, most: int) -> None:
        """Begin empty.

        Args:
            most: How many items wait at most.
        """
        self._items: deque[T] = deque()
        self._most = most
        self._changed = threading.Condition()
        self._is_closed = False
        self.dropped = 0
        """Items that went unread."""

    def put(self, item: T) -> None:
        """Add an item; after closing it is not taken."""
        with self._changed:
            if self._is_closed:
                return
            if len(self._items) == self._most:
                self._items.popleft()
                self.dropped += 1
            self._items.append(item)
            self._changed.notify()

    def get(self, timeout: float) -> T | None:
        """Take the oldest item; None if none comes within a time [s], or ever."""
        with self._changed:
            self._changed.wait_for(lambda: self._items or self._is_closed, timeout)
            return self._items.popleft() if self._items else None

    def __len__(self) -> int:
        """Count what waits."""
        return len(self._items)

    def take_all(self) -> list[T]:
        """Take all that is there."""
        with self._changed:
            items = list(self._items)
            self._items.clear()
            return items

    def close(self) -> None:
        """Say that nothing more comes; what is there can still be taken."""
        with self._changed:
            self._is_closed = True
            self._changed.notify_all()

    @property
    def is_done(self) -> bool:
        """Tell whether all has been taken and nothing more comes."""
        with self._changed:
            return self._is_closed and not self._items
