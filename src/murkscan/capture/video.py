"""A recording kept as a video file."""

from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any, final

from ..errors import FormatError
from ..types.frame import Frame
from .base import AbstractRecording, Skip, fingerprint_files, ignore_skip, spread_evenly
from .clock import Clock
from .decode import Loss, decode_pictures, grey_from_video, open_video, picture_time
from .fields import FieldOrder, split_fields
from .seek import pictures_at

_BROKEN = "cannot be decoded"
_CUT = "can no longer be read: the file ends too early"


@final
@dataclass(frozen=True)
class Video(AbstractRecording):
    """A video file. `open_recording` makes it."""

    path: Path
    size: tuple[int, int]
    order: FieldOrder
    is_timed: bool
    num_frames: int | None
    clock: Clock
    """What the container's times mean."""
    wavelength: float
    """Wavelength of the laser, for which colours are weighted [m]."""

    def frames(
        self, start: int = 0, *, on_skip: Callable[[Skip], None] = ignore_skip
    ) -> Iterator[Frame]:
        """Read the frames in order, from the one with index `start`; see the base.

        The video is decoded from its beginning, since only so the count is exact.
        """
        each, end, time = self.fields_per_picture, 0, self.clock.start
        with closing(open_video(self.path)) as container:
            for item in decode_pictures(container):
                if isinstance(item, Loss):
                    end = item.first + item.count
                    self._tell(item.first, end, start, on_skip, _CUT if item.is_cut else _BROKEN)
                    continue
                end, time = item.number + 1, picture_time(item.decoded)
                if end * each > start:
                    yield from (
                        f for f in self._read(item.decoded, item.number) if f.index >= start
                    )
        if missing := self.clock.count_missing(time):
            self._tell(end, end + missing, start, on_skip, _CUT)

    def sample(self, count: int) -> list[Frame]:
        """Read about `count` frames spread evenly over the recording; see the base.

        Frames are read at keyframes where there are enough of them, so that a long video is not
        decoded whole. Their indices follow from their times, exact where the rate is constant.
        """
        frames: list[Frame] = []
        if self.num_frames and self.clock.spacing:
            numbers = spread_evenly(self.num_frames // self.fields_per_picture, count)
            times = [self.clock.start + self.clock.spacing * number for number in numbers]
            for decoded in pictures_at(self.path, times):
                fields = self._read(decoded, self.clock.number_of(picture_time(decoded)))
                frames.append(fields[len(frames) % len(fields)])
        frames = frames or list(islice(self.frames(), count))
        if not frames:
            raise FormatError(f"No picture in {self.path} can be decoded; record it anew.")
        return frames

    def fingerprint(self) -> str:
        """Give a text that changes when the name, the size or the date of the file does."""
        return fingerprint_files([self.path])

    def _read(self, decoded: Any, number: int) -> list[Frame]:
        if (decoded.width, decoded.height) != self.size:
            raise FormatError(
                f"Picture {number} of {self.path} is {decoded.width} x {decoded.height} px, but "
                f"the recording is {self.size[0]} x {self.size[1]} px; cut the video there."
            )
        return split_fields(
            grey_from_video(decoded, self.wavelength),
            picture=number,
            time=self.clock.time_of(number, picture_time(decoded)),
            period=self.clock.period,
            order=self.order,
        )

    def _tell(
        self, first: int, end: int, start: int, on_skip: Callable[[Skip], None], what: str
    ) -> None:
        """Report lost pictures, as far as they would have come from `start` on."""
        each = self.fields_per_picture
        if end * each > start:
            span = f"Picture {first}" if end == first + 1 else f"Pictures {first} to {end - 1}"
            index = max(first * each, start)
            on_skip(Skip(index, f"{span} of {self.path} {what}.", end * each - index))
