"""What a dive's file holds."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Int

from ...errors import FormatError, InputError
from ...types.arrays import Scalars
from .clock import ClockStep
from .messages import Topic
from .open import DiveFile
from .series import Series


@dataclass(frozen=True, eq=False)
class PictureIndex:
    """The pictures of one topic, in the order of writing."""

    topic: Topic
    codecs: tuple[str, ...]
    """What they are written in, the most frequent first."""
    places: Int[np.ndarray, "n 2"]
    """Where the message of each lies: place and number, see `Message`."""
    times: Scalars
    """When each came [s since 1970], steps and jitter taken out."""
    is_key: Bool[np.ndarray, " n"]
    """Whether decoding can start at it."""
    jitter: float
    """What was taken out of stamps of arrival, one standard deviation [s]; 0 where nothing."""
    clock: str
    """Whose times they are: the log's, or the message's own."""


@dataclass(frozen=True, eq=False)
class TopicFacts:
    """One topic, for a listing."""

    topic: Topic
    num_messages: int
    times: Scalars
    """When they were written down [s since 1970], steps taken out."""
    lag: float
    """Median of the time from sending to writing down [s]."""
    use: str
    """What it is of use for; empty where for nothing here."""


@dataclass(frozen=True, eq=False)
class DiveContents:
    """All that a dive's file holds, but for the pictures themselves."""

    file: DiveFile
    topics: tuple[TopicFacts, ...]
    pictures: tuple[PictureIndex, ...]
    series: tuple[Series, ...]
    steps: tuple[ClockStep, ...]
    damage: tuple[str, ...]
    """What cannot be read, in sentences."""
    num_bytes: int

    def choose_pictures(self, topic: str | None) -> PictureIndex:
        """Give the pictures of a topic, or of the only one.

        Raises:
            InputError: There is no such topic, or none was named and there are several.
            FormatError: There are no pictures.
        """
        path, names = self.file.path, [one.topic.name for one in self.pictures]
        if not names:
            raise FormatError(
                f"{path} holds no pictures; `murkscan dive {path}` lists what it holds. If the "
                "video lies beside it, scan that and give this file with --navigation."
            )
        if topic is None and len(names) > 1:
            raise InputError(
                f"{path} holds pictures of {len(names)} cameras: {', '.join(names)}; say with "
                "--topic which are the laser's."
            )
        if topic is not None and topic not in names:
            raise InputError(
                f"{path} has no pictures in the topic {topic}; it has them in {', '.join(names)}."
            )
        return self.pictures[0 if topic is None else names.index(topic)]
