"""A dive's recording, in chapters of one clock: it outlives lost streams and killed programs."""

import re
import time
from collections.abc import Callable, Generator, Iterator
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

import av
import numpy as np

from ..errors import InputError, StreamLost
from ..io.values import load_value, save_value
from .camera import camera_images, is_camera
from .coded import Tap, tell_nobody
from .growing import RecordingProgress
from .record import record_images
from .stream import check_description, copy_stream, is_stream

_PAUSE = 0.5
"""Pause before a lost stream is asked for again [s]: one that refuses does so at once."""
_CHAPTER = re.compile(r"dive-([0-9]+)(\.part)?\.mkv")
ImageTap = Callable[[np.ndarray, float], None]
"""Is given each picture of a camera here, and its time in the recording [s]; must not wait."""


@dataclass(frozen=True)
class DiveRecord:
    """OUT/capture/dive.json: what a later run must know."""

    source: str
    began: float
    """When the first picture came, in seconds since 1970: where the recording's time is 0."""
    ended: bool = False
    """Whether the dive was ended, so that what is left is to scan it."""


@dataclass(frozen=True)
class DiveFolder:
    """OUT/capture: the chapters of a dive, dive-1.mkv, dive-2.mkv …, and their clock."""

    root: Path

    @property
    def record(self) -> DiveRecord | None:
        """Read what an earlier run left; None where there is nothing.

        Raises:
            FormatError: It is damaged.
        """
        file = self.root / "dive.json"
        return load_value(file, DiveRecord) if file.exists() else None

    def save(self, record: DiveRecord) -> None:
        """Write dive.json."""
        save_value(self.root / "dive.json", record)

    def adopt(self) -> None:
        """Give what a killed run left its name; what does not play is put aside, not removed."""
        for part in sorted(self.root.glob("dive-*.part.mkv")):
            whole = part.with_name(part.name.replace(".part", ""))
            part.rename(whole if _plays(part) else part.with_suffix(".broken"))

    @property
    def chapters(self) -> list[Path]:
        """Give the finished chapters in order."""
        found = {int(m[1]): f for f, m in self._named() if not m[2]}
        return [found[number] for number in sorted(found)]

    @property
    def next_chapter(self) -> Path:
        """Name a chapter that is not there yet."""
        numbers = [int(match[1]) for _, match in self._named()]
        return self.root / f"dive-{max(numbers, default=0) + 1}.mkv"

    def _named(self) -> Iterator[tuple[Path, "re.Match[str]"]]:
        for file in self.root.glob("dive-*"):
            match = _CHAPTER.fullmatch(file.name)
            if match:
                yield file, match


def _plays(part: Path) -> bool:
    try:
        with av.open(str(part)) as container:
            return any(packet.size for packet in container.demux(video=0))
    except (av.error.FFmpegError, OSError, IndexError):
        return False


@dataclass(frozen=True)
class DiveProgress:
    """How far a dive's recording is."""

    written: RecordingProgress | None
    """Of the chapter that grows; None while the stream is lost."""
    chapter: Path
    losses: int
    """How often the stream broke off."""


def record_dive(
    source: str,
    folder: DiveFolder,
    *,
    timeout: float = 10.0,
    patience: float = 60.0,
    tap: Tap = tell_nobody,
    image_tap: ImageTap = lambda image, time: None,
    clock: Callable[[], float] = time.time,
) -> Generator[DiveProgress, None, None]:
    """Record a stream or a camera in chapters: where it breaks off, a new one waits for it.

    All chapters have one clock, which goes on while the stream is lost, or the program is down.
    Closing the iterator ends the recording and leaves files that play.

    Args:
        source: As `copy_stream` and `camera_images` take it.
        folder: Where the chapters go; what an earlier run recorded there is gone on with.
        timeout: Longest wait for the stream and for its next picture [s].
        patience: How long a lost stream is waited for, before the dive counts as ended [s].
        tap: Given each picture of a stream as it comes.
        image_tap: Given each picture of a camera here.
        clock: Gives the seconds since 1970.

    Yields:
        How far it is, after each picture, and each time that nothing came.

    Raises:
        InputError: The source is neither a stream nor a camera.
        StreamLost: Nothing has come at all.
        DeviceError: The disk is full; what came is kept.
    """
    check_source(source)
    folder.adopt()
    losses, lost_since = 0, clock()
    has_begun = folder.record is not None

    def begin() -> float:
        record = folder.record
        if record is None:
            record = DiveRecord(source, clock())
            folder.save(record)
        return max(clock() - record.began, 0.0)

    while True:
        chapter = folder.next_chapter
        try:
            with closing(_record(source, chapter, timeout, begin, tap, image_tap)) as recording:
                for written in recording:
                    has_begun, lost_since = True, clock()
                    yield DiveProgress(written, chapter, losses)
            return
        except StreamLost:
            if not has_begun:
                raise
        losses += 1
        if clock() - lost_since > patience:
            return
        yield DiveProgress(None, chapter, losses)
        time.sleep(_PAUSE)


def check_source(source: str) -> None:
    """Refuse what is neither a stream nor a camera.

    Raises:
        InputError: It is neither, or an SDP file that is not there.
    """
    check_description(source)
    if not is_stream(source) and not is_camera(source):
        raise InputError(
            f"{source} is no stream, no camera, and no file that is there; give an address such as "
            "udp://0.0.0.0:5600, an SDP file, a camera's number, or a recording to replay."
        )


def _record(
    source: str,
    chapter: Path,
    timeout: float,
    begin: Callable[[], float],
    tap: Tap,
    image_tap: ImageTap,
) -> Generator[RecordingProgress, None, None]:
    if is_stream(source):
        return copy_stream(source, chapter, timeout=timeout, begin=begin, tap=tap)
    start: list[float] = []

    def begin_once() -> float:
        start.append(begin())
        return start[0]

    def seen() -> Iterator[tuple[np.ndarray, float]]:
        first: float | None = None
        with closing(camera_images(source)) as images:
            for image, moment in images:
                first = moment if first is None else first
                yield image, moment
                image_tap(image, start[0] + moment - first)

    return record_images(seen(), chapter, begin=begin_once)
