"""Frames spread over all of a dive so far, from which an extractor learns."""

from ..types.frame import Frame


class SpreadFrames:
    """Keeps every frame while they are few, then every second one, every fourth, and so on.

    Fields of both kinds are kept: they come in pairs.
    """

    def __init__(self, most: int) -> None:
        """Begin with none.

        Args:
            most: How many are kept at most.
        """
        self._most, self._stride, self._count = most, 1, 0
        self._kept: list[tuple[int, Frame]] = []

    def add(self, frame: Frame) -> None:
        """Take note of the next frame."""
        pair = self._count // 2
        self._count += 1
        if pair % self._stride:
            return
        self._kept.append((pair, frame))
        while len(self._kept) > self._most:
            self._stride *= 2
            self._kept = [(at, one) for at, one in self._kept if at % self._stride == 0]

    def frames(self) -> list[Frame]:
        """Give those that are kept, in order."""
        return [frame for _, frame in self._kept]
