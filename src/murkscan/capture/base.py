"""What every recording can do."""

import abc
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from ..types.frame import Frame


@dataclass(frozen=True)
class Skip:
    """Something of a recording that could not be read."""

    index: int
    """Number of the frame that is missing, or of the first of those that are."""
    reason: str
    """What is wrong, naming the file."""


def ignore_skip(skip: Skip) -> None:
    """Take no notice of what could not be read."""


class AbstractRecording(abc.ABC):
    """Pictures in order, with times. Subclasses are final; `open_recording` picks the right one."""

    path: Path
    """The folder or the file."""
    size: tuple[int, int]
    """Width and height of the full frame [px]."""
    fields_per_picture: int
    """2 where the recording is interlaced and each field is a frame, otherwise 1."""
    is_timed: bool
    """Whether frames have real times; otherwise a frame's time is the number of its picture."""
    num_frames: int | None
    """How many frames the recording claims, for a progress bar; None where it does not say."""

    @abc.abstractmethod
    def frames(
        self, start: int = 0, *, on_skip: Callable[[Skip], None] = ignore_skip
    ) -> Iterator[Frame]:
        """Read the frames in order, from the one with index `start`.

        Args:
            start: Index of the first frame wanted.
            on_skip: Told of each frame, or tail, that cannot be read; its index stays unused.
        """

    @abc.abstractmethod
    def sample(self, count: int) -> list[Frame]:
        """Read about `count` frames spread evenly over the recording, at least one."""

    @abc.abstractmethod
    def fingerprint(self) -> str:
        """Give a text that changes when the recording's files change."""
