"""A recording kept as a video file."""

from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import islice
from typing import final

import numpy as np

from ..errors import FormatError
from ..types.frame import Frame
from .base import AbstractRecording, Skip, fingerprint_files, ignore_skip, spread_evenly
from .clock import Clock
from .colour import AbstractColour
from .container import open_video
from .decode import Loss, grey_from_video, picture_time
from .fields import split_fields
from .index import VideoIndex, decode_from, index_video
from .seek import pictures_at
from .timed import TimedPicture, time_pictures

_SAME = 0.1
"""Share by which the steps of packets and of pictures may differ, by rounding."""
_WHY = {
    "broken": "cannot be decoded",
    "empty": "came without data: the recorder dropped frames there",
    "cut": "can no longer be read: the file ends too early",
    "untimed": "cannot be placed in time: by the file's clock not after the picture before; if "
    "that clock is wrong, give the pictures a second (--fps)",
}
"""What is told of pictures that are lost."""


@final
@dataclass(frozen=True)
class Video(AbstractRecording):
    """A video file. `open_recording` makes it."""

    clock: Clock
    """What the container's times mean."""
    colour: AbstractColour
    """How colours become grey levels."""

    @property
    def starts_anywhere(self) -> bool:
        """Tell whether reading can start at any frame; see the base."""
        return self.index is not None

    @cached_property
    def index(self) -> VideoIndex | None:
        """The times of all pictures; None where only decoding from the beginning is exact."""
        index = index_video(self.path)
        if index is None or not self.clock.spacing:
            return None
        # Where each field has a packet of its own, packets are no pictures.
        usual = float(np.median(np.diff(index.times)))
        return index if abs(usual - self.clock.spacing) < _SAME * usual else None

    @property
    def span(self) -> tuple[float, float]:
        """Give the times of the first and of the last picture [s], as the file claims."""
        last = max((self.num_frames or 0) // self.fields_per_picture - 1, 0)
        start = 0.0 if self.clock.rate else self.clock.start
        return start, start + last * self.clock.period

    def frames(
        self, start: int = 0, *, on_skip: Callable[[Skip], None] = ignore_skip
    ) -> Iterator[Frame]:
        """Read the frames in order, from the one with index `start`; see the base.

        The video is decoded from a keyframe before that one where its index is exact, otherwise
        from its beginning.
        """
        each = self.fields_per_picture
        index = self.index if start >= each else None
        with closing(open_video(self.path)) as container:
            items = decode_from(container, index, start // each)
            for item in time_pictures(items, self.clock):
                if isinstance(item, Loss):
                    self._tell(item, start, on_skip)
                elif (item.number + 1) * each > start:
                    yield from (frame for frame in self._split(item) if frame.index >= start)

    def sample(self, count: int) -> list[Frame]:
        """Read about `count` frames spread evenly over the recording; see the base.

        Frames are read at keyframes where there are enough of them, so that a long video is not
        decoded whole. Their indices follow from their times, and second fields come half the usual
        period after the first ones, both exact where the rate is constant.
        """
        frames: list[Frame] = []
        if self.num_frames and self.clock.spacing:
            numbers = spread_evenly(self.num_frames // self.fields_per_picture, count)
            times = [self.clock.start + self.clock.spacing * number for number in numbers]
            for decoded in pictures_at(self.path, times):
                number = self.clock.number_of(picture_time(decoded))
                time = self.clock.time_of(number, picture_time(decoded))
                fields = self._split(TimedPicture(number, decoded, time, self.clock.period))
                frames.append(fields[len(frames) % len(fields)])
        frames = frames or list(islice(self.frames(), count))
        if not frames:
            raise FormatError(f"No picture in {self.path} can be decoded; record it anew.")
        return frames

    def in_colour(self, colour: AbstractColour, *remarks: str) -> AbstractRecording:
        """Give the same recording with other grey levels; see the base."""
        return replace(self, colour=colour, remarks=(*self.remarks, *remarks))

    def fingerprint(self) -> str:
        """Give a text that changes when the recording's frames or their times would."""
        reading = (self.order, self.is_timed, self.clock, self.colour)
        return fingerprint_files([self.path], reading)

    def _split(self, picture: TimedPicture) -> list[Frame]:
        decoded, (width, height) = picture.decoded, self.size
        if (decoded.width, decoded.height) != self.size:
            raise FormatError(
                f"Picture {picture.number} of {self.path} is {decoded.width} x {decoded.height} "
                f"px, but the recording is {width} x {height} px; cut the video there."
            )
        return split_fields(
            grey_from_video(decoded, self.colour),
            picture=picture.number,
            time=picture.time,
            period=picture.period,
            order=self.order,
        )

    def _tell(self, loss: Loss, start: int, on_skip: Callable[[Skip], None]) -> None:
        """Report lost pictures, as far as their frames would have come from `start` on."""
        each = self.fields_per_picture
        index, end = max(loss.first * each, start), loss.end * each
        if index < end:
            first, last = index // each, loss.end - 1
            span = f"Picture {first}" if first == last else f"Pictures {first} to {last}"
            on_skip(Skip(index, f"{span} of {self.path} {_WHY[loss.why]}.", end - index))
