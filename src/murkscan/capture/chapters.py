"""Several files that are one recording: the chapters that cameras cut long ones into."""

import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from pathlib import Path
from typing import final

import av
import numpy as np

from ..errors import FormatError, InputError
from ..types.frame import Frame
from .base import AbstractRecording, Skip, fingerprint_files, ignore_skip, spread_evenly
from .colour import AbstractColour
from .container import demux_video, is_avi, open_video, picture_ticks
from .folder import is_picture, natural_key
from .video import Video

_VIDEOS = (".mp4", ".mov", ".mkv", ".avi", ".m4v", ".ts", ".mts", ".mpg", ".mxf", ".webm")
_GOPRO = re.compile(r"(G[HXPL])(\d\d)(\d{4})", re.IGNORECASE)
"""Names of GoPro's chapters: GX, chapter, number of the recording."""


def find_chapters(paths: Sequence[Path]) -> list[Path]:
    """Give the files of a recording in order: as they are named, or as they lie in a folder.

    A folder that holds videos and no pictures is one recording, its videos in natural order;
    GoPro's, whose names begin with the chapter, by recording and then by chapter.

    Raises:
        InputError: No file is named, one twice, or a folder among several.
        FormatError: A folder holds chapters of several recordings.
    """
    if not paths:
        raise InputError("No recording is named; give a video, a folder, an MCAP or a bag.")
    if len(paths) > 1:
        twice = next((one for k, one in enumerate(paths) if one in paths[:k]), None)
        folder = next((one for one in paths if one.is_dir()), None)
        if twice is not None or folder is not None:
            why = f"{twice} is named twice" if folder is None else f"{folder} is a folder"
            raise InputError(f"{why}; chapters of one recording are files, each named once.")
        return list(paths)
    path = paths[0]
    if not path.is_dir():
        return [path]
    there = [file for file in path.iterdir() if file.is_file() and file.name[:1] != "."]
    videos = [file for file in there if file.suffix.lower() in _VIDEOS]
    if not videos or any(is_picture(file) for file in there):
        return [path]
    names = [_GOPRO.fullmatch(file.stem) for file in videos]
    recordings = {name[3] for name in names if name}
    if len(recordings) > 1 and all(names):
        numbers = ", ".join(sorted(recordings))
        raise FormatError(
            f"{path} holds chapters of {len(recordings)} recordings ({numbers}); name the files of "
            "one, in order."
        )
    return sorted(videos, key=_chapter_key)


def _chapter_key(file: Path) -> tuple[list[tuple[int, str]], str]:
    match = _GOPRO.fullmatch(file.stem)
    return natural_key(f"{match[3]}_{match[2]}" if match else file.name)


@final
@dataclass(frozen=True)
class Chapters(AbstractRecording):
    """Videos that follow one another without a pause. `open_recording` makes it."""

    parts: tuple[AbstractRecording, ...]
    starts: tuple[int, ...]
    """Index of the first frame of each part, and behind the last one's end."""
    shifts: tuple[float, ...]
    """What is added to the times of each part [s]."""

    @property
    def starts_anywhere(self) -> bool:
        """Tell whether reading can start at any frame; see the base."""
        return all(part.starts_anywhere for part in self.parts)

    @property
    def span(self) -> tuple[float, float]:
        """Give the times of the first and of the last picture [s]."""
        return self.parts[0].span[0] + self.shifts[0], self.parts[-1].span[1] + self.shifts[-1]

    def frames(
        self, start: int = 0, *, on_skip: Callable[[Skip], None] = ignore_skip
    ) -> Iterator[Frame]:
        """Read the frames in order, from the one with index `start`; see the base."""
        for part, begin, end, shift in self._parts():
            if start >= end:
                continue

            def tell(skip: Skip, begin: int = begin, end: int = end) -> None:
                index = skip.index + begin
                if index < end:
                    on_skip(Skip(index, skip.reason, min(skip.count, end - index)))

            for frame in part.frames(max(start - begin, 0), on_skip=tell):
                if frame.index + begin < end:
                    yield _place(frame, begin, shift)

    def sample(self, count: int) -> list[Frame]:
        """Read about `count` frames spread evenly over the recording; see the base."""
        asked = np.bincount(
            np.searchsorted(self.starts, spread_evenly(self.starts[-1], count), side="right") - 1,
            minlength=len(self.parts),
        )
        return [
            _place(frame, begin, shift)
            for (part, begin, _, shift), some in zip(self._parts(), asked.tolist(), strict=True)
            if some
            for frame in part.sample(some)
        ]

    def in_colour(self, colour: AbstractColour, *remarks: str) -> AbstractRecording:
        """Give the same recording with other grey levels; see the base."""
        parts = tuple(part.in_colour(colour) for part in self.parts)
        return replace(self, parts=parts, remarks=(*self.remarks, *remarks))

    def fingerprint(self) -> str:
        """Give a text that changes when the recording's frames or their times would."""
        reading = ([part.fingerprint() for part in self.parts], self.starts, self.shifts)
        return fingerprint_files([part.path for part in self.parts], reading)

    def _parts(self) -> Iterator[tuple[AbstractRecording, int, int, float]]:
        yield from zip(self.parts, self.starts[:-1], self.starts[1:], self.shifts, strict=True)


def open_chapters(parts: Sequence[AbstractRecording]) -> Chapters:
    """Join recordings into one: each begins one picture after the last one of the part before.

    A Matroska file that itself begins later keeps its times: `murkscan live` writes chapters so
    where a stream was lost for a while, since the camera moved on meanwhile.

    Raises:
        FormatError: They differ in size or in their fields.
        InputError: One of them is no video.
    """
    first = parts[0]
    for part in parts:
        if not isinstance(part, Video):
            raise InputError(f"{part.path} is no video; only videos are chapters of one recording.")
        if part.size != first.size or part.is_timed != first.is_timed:
            raise FormatError(
                f"{part.path} has pictures of {part.size[0]} x {part.size[1]} px, {first.path} of "
                f"{first.size[0]} x {first.size[1]} px; they are no chapters of one recording."
            )
    # A chapter in which little moves may leave open what its neighbours tell.
    order = next((part.order for part in parts if part.order != "progressive"), first.order)
    each = 1 if order == "progressive" else 2
    same = [
        replace(part, order=order, num_frames=_claimed(part, each))
        for part in parts
        if isinstance(part, Video)
    ]
    counts = [_count_pictures(part) for part in same]
    starts = [0, *(np.cumsum(counts) * each).tolist()]
    shifts, begin = [], first.span[0]
    for part, count in zip(same, counts, strict=True):
        is_later = part.path.suffix.lower() == ".mkv" and part.span[0] > begin
        shifts.append(0.0 if is_later else begin - part.span[0])
        begin = shifts[-1] + _end(part, count)
    said = [f"{part.path.name}: {remark}" for part in same for remark in part.remarks]
    names = ", ".join(part.path.name for part in same[:4]) + (" …" if len(same) > 4 else "")
    return Chapters(
        path=first.path,
        size=first.size,
        order=order,
        is_timed=first.is_timed,
        num_frames=starts[-1],
        remarks=(f"{len(same)} chapters are one recording: {names}", *said),
        parts=tuple(same),
        starts=tuple(starts),
        shifts=tuple(shifts),
    )


def _end(part: Video, count: int) -> float:
    """Compute when the picture after a part's last one would come, by the part's own times [s]."""
    if part.index is not None and part.clock.rate is None:
        return float(part.index.times[-1]) + part.clock.period
    return part.span[0] + count * part.clock.period


def _claimed(part: Video, each: int) -> int | None:
    """Count the frames that a video claims, each picture being one or two."""
    return None if part.num_frames is None else part.num_frames // part.fields_per_picture * each


def _count_pictures(part: Video) -> int:
    """Count the pictures that a video has, those without data too.

    Raises:
        FormatError: The file cannot be read through.
    """
    if part.index is not None:
        return len(part.index.times)
    with closing(open_video(part.path)) as container:
        stream = container.streams.video[0]
        if stream.frames:
            return stream.frames // max(picture_ticks(container) if is_avi(container) else 1, 1)
        try:
            return sum(packet.size > 0 for packet in demux_video(container))
        except av.error.FFmpegError as error:
            raise FormatError(f"{part.path} breaks off; mend it, or leave it out.") from error


def _place(frame: Frame, begin: int, shift: float) -> Frame:
    return replace(frame, index=frame.index + begin, time=frame.time + shift)
