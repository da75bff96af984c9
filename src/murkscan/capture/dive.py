"""A recording kept in a dive's file of messages: MCAP or a bag."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from typing import final

import numpy as np

from ..errors import FormatError
from ..io.dive.contents import DiveContents, PictureIndex
from ..io.dive.open import DiveFile
from ..io.dive.pictures import RAW, VIDEO
from ..types.arrays import Image
from ..types.frame import Frame
from .base import AbstractRecording, Skip, fingerprint_files, ignore_skip, spread_evenly
from .colour import AbstractColour
from .dive_pictures import decode_from_keyframe, pictures_near
from .field_order import RUN, Fields, decide_order, say_order
from .fields import split_fields

_FIRST = 300
"""Messages among which a picture must be, or there is none that can be decoded: ten seconds of
video, between whose keyframes a recording may begin."""


@final
@dataclass(frozen=True)
class DivePictures(AbstractRecording):
    """The pictures of one topic of an MCAP or a bag. `open_recording` makes it."""

    file: DiveFile
    index: PictureIndex
    colour: AbstractColour
    """How colours become grey levels."""

    @property
    def starts_anywhere(self) -> bool:
        """Tell whether reading can start at any frame; see the base."""
        return True

    @property
    def span(self) -> tuple[float, float]:
        """Give the times of the first and of the last picture [s since 1970]."""
        return float(self.index.times[0]), float(self.index.times.max())

    def frames(
        self, start: int = 0, *, on_skip: Callable[[Skip], None] = ignore_skip
    ) -> Iterator[Frame]:
        """Read the frames in order, from the one with index `start`; see the base."""
        each = self.fields_per_picture
        first = start // each
        number = first
        for found, image, why in decode_from_keyframe(self.file, self.index, self.colour, first):
            if found < first:
                continue
            if found > number:
                self._tell(number, found, start, "cannot be decoded", on_skip)
            number = found + 1
            if image is None:
                self._tell(found, found + 1, start, why, on_skip)
            elif not self._has_time(found):
                why = "comes, by the file's clock, not after the picture before"
                self._tell(found, found + 1, start, why, on_skip)
            else:
                yield from (one for one in self._split(image, found) if one.index >= start)
        if number < len(self.index.times):
            self._tell(number, len(self.index.times), start, "cannot be decoded", on_skip)

    def sample(self, count: int) -> list[Frame]:
        """Read about `count` frames spread evenly over the recording; see the base."""
        frames: list[Frame] = []
        for number in spread_evenly(len(self.index.times), count):
            found, image = next(pictures_near(self.file, self.index, self.colour, number, 1))
            if image is not None and self._has_time(found):
                fields = self._split(image, found)
                frames.append(fields[len(frames) % len(fields)])
        frames = list({frame.index: frame for frame in frames}.values())
        frames = frames or list(islice(self.frames(), count))
        if not frames:
            raise FormatError(f"No picture in {self.path} can be decoded.")
        return sorted(frames, key=lambda frame: frame.index)

    def in_colour(self, colour: AbstractColour, *remarks: str) -> AbstractRecording:
        """Give the same recording with other grey levels; see the base."""
        return replace(self, colour=colour, remarks=(*self.remarks, *remarks))

    def fingerprint(self) -> str:
        """Give a text that changes when the recording's frames or their times would."""
        times = self.index.times.tobytes().hex()[:64]
        reading = (self.index.topic.name, self.order, times, self.index.jitter, self.colour)
        return fingerprint_files(self.file.files, reading)

    def _has_time(self, number: int) -> bool:
        """Tell whether a picture comes after all before it."""
        times = self.index.times
        return number == 0 or bool(times[number] > times[max(number - 100, 0) : number].max())

    def _split(self, image: Image, number: int) -> list[Frame]:
        height, width = len(image), image.shape[1] // self.colour.channels
        if (width, height) != self.size:
            raise FormatError(
                f"Picture {number} of {self.path} is {width} x {height} px, but the recording is "
                f"{self.size[0]} x {self.size[1]} px; cut the recording there."
            )
        times, usual = self.index.times, _spacing(self.index)
        apart = float(times[number + 1] - times[number]) if number + 1 < len(times) else usual
        return split_fields(
            image,
            picture=number,
            time=float(times[number]),
            period=min(apart, usual) if apart > 0 else usual,
            order=self.order,
        )

    def _tell(
        self, first: int, end: int, start: int, why: str, on_skip: Callable[[Skip], None]
    ) -> None:
        each = self.fields_per_picture
        index = max(first * each, start)
        if index < end * each:
            span = f"Picture {first}" if end == first + 1 else f"Pictures {first} to {end - 1}"
            on_skip(Skip(index, f"{span} of {self.path} {why}.", end * each - index))


def open_dive_pictures(
    contents: DiveContents, topic: str | None, colour: AbstractColour, fields: Fields
) -> DivePictures:
    """Open the pictures of a dive's file; see `open_recording`.

    Raises:
        InputError: No topic was named and several have pictures, or the one named has none.
        FormatError: It holds no pictures, or none that can be decoded.
    """
    index, file = contents.choose_pictures(topic), contents.file
    _refuse_unread(file, index)
    first = next((image for _, image, _ in _first(file, index, colour)), None)
    if first is None:
        raise FormatError(
            f"None of the first {min(_FIRST, len(index.times))} pictures of {index.topic.name} in "
            f"{file.path} can be decoded as {index.codecs[0]}: it may be encrypted, or damaged."
        )
    height, width = first.shape

    def runs(count: int) -> Iterator[Sequence[Image]]:
        for number in spread_evenly(max(len(index.times) - RUN, 1), count):
            run = pictures_near(file, index, colour, number, RUN)
            images = [image for _, image in run if image is not None]
            yield [image for image in images if image.shape == (height, width)]

    order = decide_order(fields, runs)
    return DivePictures(
        path=file.path,
        size=(width, height),
        order=order,
        is_timed=len(index.times) > 1,
        num_frames=len(index.times) * (1 if order == "progressive" else 2),
        remarks=(*say_order(order, fields), *contents.damage, *_say_clock(contents, index)),
        file=file,
        index=index,
        colour=colour,
    )


def _refuse_unread(file: DiveFile, index: PictureIndex) -> None:
    codecs = index.codecs or ("nothing",)
    if not any(one in VIDEO or one in RAW or one == "still" for one in codecs):
        raise FormatError(
            f"{index.topic.name} in {file.path} holds pictures as {codecs[0][:40]!r}, which is not "
            f"read; read are {', '.join(VIDEO)}, jpeg, png and raw pictures of "
            f"{', '.join(list(RAW)[:8])} …"
        )


def _first(
    file: DiveFile, index: PictureIndex, colour: AbstractColour
) -> Iterator[tuple[int, Image, str]]:
    for found, image, why in decode_from_keyframe(file, index, colour, 0):
        if found >= _FIRST:
            return
        if image is not None:
            yield found, image, why


def _say_clock(contents: DiveContents, index: PictureIndex) -> tuple[str, ...]:
    """Say what was done to the pictures' times."""
    said = [
        f"the recorder's clock was put {'forward' if step.size > 0 else 'back'} by "
        f"{abs(step.size):.3f} s during the dive; times go on as if it had not been"
        for step in contents.steps
    ]
    if index.jitter:
        said.append(
            f"its pictures are stamped as they arrived, uneven by {index.jitter * 1e3:.0f} ms "
            "(1σ); their times are smoothed, but how late all of them are is not known "
            "(--time-offset-s)"
        )
    return tuple(said)


def _spacing(index: PictureIndex) -> float:
    return float(np.median(np.diff(index.times))) if len(index.times) > 1 else 1.0
