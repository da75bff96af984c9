"""From a path to a recording."""

import math
from collections.abc import Iterable, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import av

from ..errors import FormatError, InputError
from ..io.dive.names import is_dive
from ..io.picture_notes import count_pages
from ..types.arrays import Image
from .ambient import see_by_colour
from .base import AbstractRecording
from .chapters import find_chapters, open_chapters
from .clock import Clock, usual_spacing
from .colour import LaserColour
from .container import open_video, picture_ticks
from .decode import Picture, decode_pictures, grey_from_video, picture_time
from .field_order import RUN, RUNS, Fields, decide_order, say_order
from .fields import FieldOrder
from .folder import is_picture
from .open_folder import open_folder
from .seek import read_runs
from .video import Video

_SLACK = 0.5
"""By how much other streams, such as sound, may outlast the pictures [s]."""


def open_recording(
    path: Path | str | Sequence[Path | str],
    *,
    wavelength: float = 532e-9,
    fps: float | None = None,
    fields: Fields = "auto",
    topic: str | None = None,
) -> AbstractRecording:
    """Open a folder of pictures, a TIFF of several pages, a video file, or a dive's MCAP or bag.

    Args:
        path: The folder or the file; several files in order, or a folder with nothing but videos,
            are chapters of one recording.
        wavelength: Wavelength of the laser, for which colours are weighted [m]. Where daylight or
            a lamp shows as well, and the line's colour tells it better, a frame shows how much
            more of that colour there is.
        fps: Pictures a second: for a folder without times.csv, or in place of a video's own times
            (a high-speed camera's file plays slowly). Without either, a frame's time is the
            number of its picture.
        fields: Whether a picture is two interlaced fields, and which came first; by itself it is
            found from some 25 pictures.
        topic: The topic of the pictures, where an MCAP or a bag has several cameras.

    Raises:
        InputError: There is nothing at the path, or a setting makes no sense.
        FormatError: It is no recording, nothing in it can be read, or times.csv is wrong.
        MissingDependency: What reads it is not installed.
    """
    paths = [Path(path)] if isinstance(path, Path | str) else [Path(one) for one in path]
    for one in paths:
        _check(one, wavelength, fps)
    colour = LaserColour.mean(wavelength)
    chapters = find_chapters(paths)
    if len(chapters) > 1:
        parts = [_open_one(one, colour, fps, fields, topic) for one in chapters]
        return see_by_colour(open_chapters(parts), wavelength)
    return see_by_colour(_open_one(chapters[0], colour, fps, fields, topic), wavelength)


def _open_one(
    path: Path, colour: LaserColour, fps: float | None, fields: Fields, topic: str | None
) -> AbstractRecording:
    if is_dive(path):
        from ..io.dive.gather import read_contents
        from .dive import open_dive_pictures

        if fps is not None:
            raise InputError(f"{path} has times of its own; leave out --fps.")
        return open_dive_pictures(read_contents(path), topic, colour, fields)
    if topic is not None:
        raise InputError(f"{path} has no topics; leave out --topic.")
    if path.is_dir():
        return open_folder(path, colour, fps, fields)
    if is_picture(path):
        if count_pages(path) == 1:
            raise FormatError(f"{path} is a single picture; give the folder that it lies in.")
        return open_folder(path, colour, fps, fields)
    return _open_video(path, colour, fps, fields)


def _check(path: Path, wavelength: float, fps: float | None) -> None:
    if (
        "://" in str(path)
        or path.suffix.lower() == ".sdp"
        or str(path).startswith(("udp:", "rtsp:"))
    ):
        raise InputError(
            f"{path} is a live stream; record it first with 'murkscan capture {path} dive.mkv'."
        )
    if not path.exists():
        raise InputError(f"There is no recording at {path}; check the spelling of the path.")
    if not 100e-9 < wavelength < 3e-6:
        raise InputError(
            f"A laser of {wavelength * 1e9:g} nm cannot be meant; the wavelength of a green one "
            "is 532 nm."
        )
    if fps is not None and not (math.isfinite(fps) and fps > 0):
        raise InputError(f"A recording needs more than 0 pictures a second, got {fps:g}.")


def _open_video(path: Path, colour: LaserColour, fps: float | None, fields: Fields) -> Video:
    facts = _look_at(path)
    times = [facts.start + facts.duration * i / RUNS[0] for i in range(RUNS[0])]
    first_runs = list(read_runs(path, times, RUNS[0] * RUN))
    spacing = usual_spacing([[picture_time(decoded) for decoded in run] for run in first_runs])
    claimed = facts.num_pictures or (round(facts.duration / spacing) if spacing else 0)
    clock = Clock(facts.start, spacing, fps, facts.promised_end)

    def runs(count: int) -> Iterable[list[Image]]:
        times = [facts.start + facts.duration * i / count for i in range(count)]
        found = first_runs if count == RUNS[0] else read_runs(path, times, count * RUN)
        return (
            [grey_from_video(d, colour) for d in piece if (d.width, d.height) == facts.size]
            for run in found
            for piece in _cut_run(run)
        )

    flag: FieldOrder = "top-first" if facts.is_flagged else "progressive"
    order = decide_order(fields, runs, flag)
    return Video(
        path=path,
        size=facts.size,
        order=order,
        is_timed=clock.is_real,
        num_frames=claimed * (1 if order == "progressive" else 2) or None,
        remarks=(*say_order(order, fields), *facts.remarks),
        clock=clock,
        colour=colour,
    )


def _cut_run(run: Sequence[Any]) -> Iterable[Sequence[Any]]:
    """Cut a long run, where a video has few keyframes, into short ones that have to agree."""
    return (run[start : start + RUN] for start in range(0, len(run), RUN))


@dataclass(frozen=True)
class _Facts:
    """What a video's container says, and its first picture shows."""

    start: float
    """Time of the first picture in the container [s]; 0 where it has none."""
    size: tuple[int, int]
    is_flagged: bool
    """Whether the first picture is marked as interlaced."""
    num_pictures: int
    """Pictures that the container counts; 0 where it does not."""
    duration: float
    """Length that the container claims [s]; 0 where it does not."""
    promised_end: float
    """When pictures end by that length [s]; -inf where the container counts them instead."""
    remarks: tuple[str, ...]
    """What is odd, in sentences."""


def _look_at(path: Path) -> _Facts:
    with closing(open_video(path)) as container:
        first = next((i for i in decode_pictures(container) if isinstance(i, Picture)), None)
        if first is None:
            raise FormatError(f"No picture in {path} can be decoded; record it anew.")
        stream, decoded = container.streams.video[0], first.decoded
        start = _find_start(stream, first)
        duration = (container.duration or 0) / av.time_base
        if stream.duration:
            duration = float(stream.duration * stream.time_base)
        elif container.format.name.startswith("matroska") and duration > start:
            duration -= start  # FFmpeg writes there when the recording ends, not how long it is.
        counts = stream.frames > 0 or duration == 0
        slack = _SLACK if len(container.streams) > 1 else 0.0
        return _Facts(
            start=start,
            size=(decoded.width, decoded.height),
            is_flagged=decoded.interlaced_frame,
            num_pictures=stream.frames // max(picture_ticks(container), 1),
            duration=duration,
            promised_end=-math.inf if counts else start + duration - slack,
            remarks=_say_turn(decoded),
        )


def _say_turn(decoded: Any) -> tuple[str, ...]:
    if not decoded.rotation:
        return ()
    return (
        f"a note asks to turn its pictures by {abs(decoded.rotation):g} degrees; they stay as they "
        "were recorded",
    )


def _find_start(stream: Any, first: Picture) -> float:
    """Give the time of the first picture [s], even if others had to be decoded before one came."""
    time = picture_time(first.decoded)
    if first.number > 0 and stream.start_time is not None:
        return float(stream.start_time * stream.time_base)
    return 0.0 if math.isnan(time) else time
