"""What every recording can do."""

import abc
import hashlib
import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..types.frame import Frame
from .colour import AbstractColour
from .fields import FieldOrder


@dataclass(frozen=True)
class Skip:
    """Frames in a row that a recording should have and does not give."""

    index: int
    """Index of the first of them that was asked for."""
    reason: str
    """What is wrong, naming the file."""
    count: int
    """How many they are, from `index` on: a picture of two fields counts as two."""


def ignore_skip(skip: Skip) -> None:
    """Take no notice of what could not be read."""


@dataclass(frozen=True)
class AbstractRecording(abc.ABC):
    """Pictures in order, with times. Subclasses are final; `open_recording` picks the right one."""

    path: Path
    """The folder or the file."""
    size: tuple[int, int]
    """Width and height of the full frame [px]."""
    order: FieldOrder
    """Whether a picture is one frame or two fields, and which of them came first."""
    is_timed: bool
    """Whether frames have real times; otherwise a frame's time is the number of its picture."""
    num_frames: int | None
    """How many frames the recording claims, for a progress bar; None where it does not say."""
    remarks: tuple[str, ...]
    """What was found out on opening that a user should know, in sentences."""

    @property
    @abc.abstractmethod
    def span(self) -> tuple[float, float]:
        """Give the times of the first and the last picture [s]; the same where unknown."""

    @property
    @abc.abstractmethod
    def starts_anywhere(self) -> bool:
        """Tell whether reading can start at any frame without reading those before it."""

    @property
    def fields_per_picture(self) -> int:
        """2 where the recording is interlaced and each field is a frame, otherwise 1."""
        return 1 if self.order == "progressive" else 2

    @abc.abstractmethod
    def frames(
        self, start: int = 0, *, on_skip: Callable[[Skip], None] = ignore_skip
    ) -> Iterator[Frame]:
        """Read the frames in order, from the one with index `start`; their times strictly increase.

        Args:
            start: Index of the first frame wanted.
            on_skip: Told of frames that cannot be read or have no time of their own, each once
                and before the frame that follows them; their indices stay unused.

        Raises:
            FormatError: A picture has another size than the first one.
        """

    @abc.abstractmethod
    def sample(self, count: int) -> list[Frame]:
        """Read about `count` frames spread evenly over the recording, at least one.

        What cannot be read is left out without a word; where fields are frames, both kinds come.

        Raises:
            FormatError: Nothing can be read, or a picture has another size than the first one.
        """

    @abc.abstractmethod
    def in_colour(self, colour: AbstractColour, *remarks: str) -> "AbstractRecording":
        """Give the same recording with other grey levels, and with remarks on them."""

    @abc.abstractmethod
    def fingerprint(self) -> str:
        """Give a text that changes when the recording's frames or their times would."""


def spread_evenly(total: int, count: int) -> list[int]:
    """Give at most `count` numbers spread over 0 … total - 1, both ends among them."""
    return sorted({round(float(x)) for x in np.linspace(0, total - 1, max(count, 1))})


def fingerprint_files(files: Sequence[Path], reading: object) -> str:
    """Give a text that changes when a name, a size or a date of the files does.

    Args:
        files: The files that hold the pictures.
        reading: Whatever else the frames and their times depend on; its `repr` counts.
    """
    digest = hashlib.sha256(os.fsencode(f"{reading!r}\n"))
    for file in files:
        state = file.stat()
        digest.update(os.fsencode(f"{file.name}\0{state.st_size}\0{state.st_mtime_ns}\n"))
    return digest.hexdigest()
