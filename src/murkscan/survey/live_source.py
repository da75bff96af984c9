"""Where a dive's frames come from: a stream or a camera, or a recording that is replayed."""

import abc
import threading
import time
from collections import deque
from contextlib import closing
from dataclasses import replace
from typing import ClassVar, final

import numpy as np

from ..capture import (
    AbstractRecording,
    ArrivedFrame,
    ArrivedPicture,
    CodedPicture,
    DiveFolder,
    DiveProgress,
    FrameSplitter,
    LaserColour,
    StreamDecoder,
    is_camera,
    record_dive,
)
from ..capture.field_order import Fields
from ..errors import MurkscanError
from ..live import Mailbox
from ..live.status import Recorded
from ..types.rig import Rig
from .live_finder import LiveFinder

_WAIT = 0.25
_CODED = 250
"""Pictures that wait to be decoded at most: ten seconds of them."""
_LATE = 0.5
"""Age from which a picture is late to be decoded [s]."""
_IMAGES = 8
"""The same of a camera here, whose pictures are not compressed."""
_MOMENT = 0.01
_SILENT = 2.0
"""Time without a picture after which a stream counts as lost [s]."""


class LiveSource(abc.ABC):
    """Gives frames to a finder until it is stopped or its pictures end."""

    word: ClassVar[str]
    """What goes on, in a word."""
    is_replayed: ClassVar[bool] = False
    """Whether the pictures are of before."""

    def __init__(self) -> None:
        """Begin with nothing."""
        self.recorded = Recorded()
        """What is on the disk."""
        self.failure: MurkscanError | None = None
        """Why it ended, if by an error."""
        self.start = 0.0
        """Time of the first picture [s]."""
        self.is_over = threading.Event()
        """Set when it has ended, and all that was recorded is whole."""
        self._stopping, self._last = threading.Event(), time.monotonic()

    @property
    def silence(self) -> float:
        """Time since the last picture, or since the beginning [s]; 0 below two seconds."""
        silent = time.monotonic() - self._last
        return silent if silent > _SILENT else 0.0

    def stop(self) -> None:
        """End the dive with the next picture, or when the stream's silence is noticed."""
        self._stopping.set()

    def run(self, finder: LiveFinder) -> None:
        """Give frames to a finder, until stopped; an error ends it and is kept."""
        try:
            self._give(finder)
        except MurkscanError as error:
            self.failure = error
        finally:
            finder.frames.close()
            self.is_over.set()

    @abc.abstractmethod
    def _give(self, finder: LiveFinder) -> None: ...


@final
class RecordedSource(LiveSource):
    """A stream or a camera: each picture goes to the disk first, and then to the finder."""

    word: ClassVar[str] = "Recording."

    def __init__(
        self,
        source: str,
        folder: DiveFolder,
        rig: Rig,
        *,
        fields: Fields = "auto",
        timeout: float = 10.0,
        patience: float = 60.0,
    ) -> None:
        """Take what `record_dive` takes, and the fields as `FrameSplitter` does."""
        super().__init__()
        self._source, self._folder, self._rig = source, folder, rig
        self._colour = LaserColour.mean(rig.wavelength)
        self._timeout, self._patience, self._fields = timeout, patience, fields
        self._coded = Mailbox[tuple[int, CodedPicture]](_CODED)
        self._images = Mailbox[tuple[np.ndarray, ArrivedPicture]](_IMAGES)
        there = sum(chapter.stat().st_size for chapter in folder.chapters)
        self._backlog = deque[tuple[int, CodedPicture]]()
        self._number, self._earlier = 0, Recorded(bytes=there)

    def _give(self, finder: LiveFinder) -> None:
        decoding = threading.Thread(target=self._decode, args=(finder,), daemon=True)
        decoding.start()
        recording = record_dive(
            self._source,
            self._folder,
            timeout=self._timeout,
            patience=self._patience,
            tap=self._tap,
            image_tap=self._tap_image,
        )
        try:
            with closing(recording):
                for progress in recording:
                    self._note(progress)
                    if self._stopping.is_set():
                        return
        finally:
            self._coded.close()
            self._images.close()
            decoding.join()

    def _note(self, progress: DiveProgress) -> None:
        """Add up what the chapters have."""
        written = progress.written
        if written is None:
            self._earlier = replace(self.recorded, losses=progress.losses)
            self.recorded = self._earlier
            return
        self._last = time.monotonic()
        self.recorded = Recorded(
            pictures=self._earlier.pictures + written.frames,
            time=written.seconds,
            bytes=self._earlier.bytes + written.bytes,
            file=f"{self._folder.root.name}/{progress.chapter.stem}.part.mkv",
            losses=progress.losses,
        )

    def _tap(self, coded: CodedPicture) -> None:
        self._coded.put((self._number, coded))
        self._number += 1

    def _tap_image(self, image: np.ndarray, moment: float) -> None:
        nothing = np.zeros((0, 0), np.uint8)
        now = time.monotonic()
        self._images.put((image, ArrivedPicture(nothing, self._number, moment, now)))
        self._number += 1

    def _decode(self, finder: LiveFinder) -> None:
        """Decode what has come, in a thread of its own, so that recording never waits for it."""
        decoder, splitter = StreamDecoder(self._colour), FrameSplitter(self._fields)
        try:
            while self._backlog or not (self._coded.is_done and self._images.is_done):
                for picture in self._next_pictures(decoder, finder):
                    _check_size(picture, self._rig, self._source)
                    for frame in splitter.split(picture):
                        finder.frames.put(frame)
        except Exception as error:  # whatever it is, the recording goes on
            finder.failure = str(error)

    def _next_pictures(self, decoder: StreamDecoder, finder: LiveFinder) -> list[ArrivedPicture]:
        if is_camera(self._source):
            image = self._images.get(_WAIT)
            if image is None:
                return []
            return [replace(image[1], image=self._colour.grey(image[0]))]
        if not self._backlog:
            came = self._coded.get(_WAIT)
            self._backlog += [] if came is None else [came]
        finder.undecoded += self._catch_up()
        return decoder.decode(*self._backlog.popleft()) if self._backlog else []

    def _catch_up(self) -> int:
        """Where decoding is late, go on at the newest keyframe; count what is passed over."""
        if not self._backlog or time.monotonic() - self._backlog[0][1].arrived < _LATE:
            return 0
        self._backlog += self._coded.take_all()
        keys = [at for at, (_, coded) in enumerate(self._backlog) if coded.is_keyframe]
        passed = keys[-1] if keys else 0
        for _ in range(passed):
            self._backlog.popleft()
        return passed


def _check_size(picture: ArrivedPicture, rig: Rig, source: str) -> None:
    height, width = picture.image.shape
    if (width, height) != tuple(rig.camera.size):
        raise ValueError(
            f"{source} sends pictures of {width} × {height} px but the rig's camera has "
            f"{rig.camera.size[0]} × {rig.camera.size[1]}; give the rig of this camera. The "
            "recording goes on."
        )


@final
class ReplayedSource(LiveSource):
    """A recording at its own speed, or as fast as it can be looked at; nothing is dropped.

    It stays where it is, and nothing is recorded.
    """

    word: ClassVar[str] = "Replaying."
    is_replayed: ClassVar[bool] = True

    def __init__(self, recording: AbstractRecording) -> None:
        """Take a recording with times."""
        super().__init__()
        self._recording, self.start = recording, recording.span[0]

    def _give(self, finder: LiveFinder) -> None:
        began, start = time.monotonic(), self.start
        each = self._recording.fields_per_picture
        for frame in self._recording.frames():
            due = began + frame.time - start
            if self._stopping.wait(max(due - time.monotonic(), 0.0)):
                return
            began += self._wait_for(finder)
            self._last = time.monotonic()
            finder.frames.put(ArrivedFrame(frame, self._last))
            self.recorded = Recorded(frame.index // each + 1, frame.time - start)

    def _wait_for(self, finder: LiveFinder) -> float:
        """Wait until the finder has room; gives for how long [s]."""
        began = time.monotonic()
        while finder.is_busy and not self._stopping.wait(_MOMENT):
            self._last = time.monotonic()
        return time.monotonic() - began
