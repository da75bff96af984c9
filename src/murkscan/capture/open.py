"""From a path to a recording."""

import math
from collections.abc import Callable, Iterable, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import av
import numpy as np

from ..errors import FormatError, InputError
from ..io.times_csv import read_times
from ..types.arrays import Image
from .base import AbstractRecording, spread_evenly
from .clock import Clock, usual_spacing
from .container import open_video
from .decode import Picture, decode_pictures, grey_from_video, picture_time
from .fields import FieldOrder, FieldVerdict, find_field_order
from .folder import TIMES, ImageFolder, is_picture, list_pictures, read_grey
from .seek import read_runs
from .video import Video

Fields = Literal["auto", "progressive", "top-first", "bottom-first"]
"""What the pictures are made of: found from the pictures, or said."""

_RUN = 5
"""Pictures in a run that is looked at for fields."""
_RUNS = (5, 20)
"""Runs to look at; the second number where the first left it open."""
_SLACK = 0.5
"""By how much other streams, such as sound, may outlast the pictures [s]."""


def open_recording(
    path: Path | str,
    *,
    wavelength: float = 532e-9,
    fps: float | None = None,
    fields: Fields = "auto",
) -> AbstractRecording:
    """Open a folder of pictures, or a video file.

    Args:
        path: The folder or the file.
        wavelength: Wavelength of the laser, for which colours are weighted [m].
        fps: Pictures a second: for a folder without times.csv, or in place of a video's own times
            (a high-speed camera's file plays slowly). Without either, a frame's time is the
            number of its picture.
        fields: Whether a picture is two interlaced fields, and which came first; by itself it is
            found from some 25 pictures.

    Raises:
        InputError: There is nothing at the path, or a setting makes no sense.
        FormatError: It is no recording, nothing in it can be read, or times.csv is wrong.
    """
    path = Path(path)
    _check(path, wavelength, fps)
    if path.is_dir():
        return _open_folder(path, wavelength, fps, fields)
    if is_picture(path):
        raise FormatError(f"{path} is a single picture; give the folder that it lies in.")
    return _open_video(path, wavelength, fps, fields)


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


def _open_folder(path: Path, wavelength: float, fps: float | None, fields: Fields) -> ImageFolder:
    files = list_pictures(path)
    is_listed = (path / TIMES).exists()
    if is_listed and fps is not None:
        raise InputError(
            f"{path / TIMES} gives the times of the pictures, so {fps:g} pictures a second cannot "
            "hold as well; leave that out, or remove the file."
        )
    times = read_times(path / TIMES, files) if is_listed else _even_times(len(files), fps or 1.0)
    height, width = _first_image(path, files, wavelength).shape
    order = _decide(fields, lambda count: _folder_runs(path, files, wavelength, count))
    each = 1 if order == "progressive" else 2
    return ImageFolder(
        path=path,
        size=(width, height),
        order=order,
        is_timed=is_listed or fps is not None,
        num_frames=len(files) * each,
        files=files,
        times=times,
        spacing=usual_spacing([times]) or 1 / (fps or 1.0),
        wavelength=wavelength,
    )


def _even_times(count: int, rate: float) -> tuple[float, ...]:
    return tuple(float(number) for number in np.arange(count) / rate)


def _first_image(path: Path, files: Sequence[str], wavelength: float) -> Image:
    for name in files:
        try:
            return read_grey(path / name, wavelength)
        except FormatError:
            continue
    raise FormatError(
        f"None of the {len(files)} pictures in {path} can be read; copy them anew from the camera."
    )


def _folder_runs(
    path: Path, files: Sequence[str], wavelength: float, count: int
) -> Iterable[list[Image]]:
    """Read runs of pictures that follow one another, those of a run all of one size."""
    # Runs that share pictures would only seem to agree.
    apart = min(count, max(len(files) // _RUN, 1))
    for start in spread_evenly(max(len(files) - _RUN + 1, 1), apart):
        run: list[Image] = []
        for name in files[start : start + _RUN]:
            try:
                image = read_grey(path / name, wavelength)
            except FormatError:
                continue
            if not run or image.shape == run[0].shape:
                run.append(image)
        yield run


def _decide(
    fields: Fields,
    runs: Callable[[int], Iterable[Sequence[Image]]],
    flag: FieldOrder = "progressive",
) -> FieldOrder:
    """Take what the user says; else what the pictures tell; else, where nothing moves, the flag.

    That they are fields must be told by the second, longer look, too.

    Fields of an order that nothing tells are taken as the flag says, or top first, as PAL has them.
    """
    if fields != "auto":
        return fields
    verdict: FieldVerdict = "undecided"
    for count in _RUNS:
        # A stripe that creeps makes a few pictures lean as fields do: those get a second look.
        verdict = find_field_order(runs(count))
        if verdict == "progressive":
            return verdict
    if verdict == "top-first" or verdict == "bottom-first":
        return verdict
    return "top-first" if verdict == "interlaced" and flag == "progressive" else flag


def _open_video(path: Path, wavelength: float, fps: float | None, fields: Fields) -> Video:
    facts = _look_at(path)
    times = [facts.start + facts.duration * i / _RUNS[0] for i in range(_RUNS[0])]
    first_runs = list(read_runs(path, times, _RUNS[0] * _RUN))
    spacing = usual_spacing([[picture_time(decoded) for decoded in run] for run in first_runs])
    claimed = facts.num_pictures or (round(facts.duration / spacing) if spacing else 0)
    clock = Clock(facts.start, spacing, fps, facts.promised_end)

    def runs(count: int) -> Iterable[list[Image]]:
        times = [facts.start + facts.duration * i / count for i in range(count)]
        found = first_runs if count == _RUNS[0] else read_runs(path, times, count * _RUN)
        return (
            [grey_from_video(d, wavelength) for d in piece if (d.width, d.height) == facts.size]
            for run in found
            for piece in _cut_run(run)
        )

    flag: FieldOrder = "top-first" if facts.is_flagged else "progressive"
    order = _decide(fields, runs, flag)
    return Video(
        path=path,
        size=facts.size,
        order=order,
        is_timed=clock.is_real,
        num_frames=claimed * (1 if order == "progressive" else 2) or None,
        clock=clock,
        wavelength=wavelength,
    )


def _cut_run(run: Sequence[Any]) -> Iterable[Sequence[Any]]:
    """Cut a long run, where a video has few keyframes, into short ones that have to agree."""
    return (run[start : start + _RUN] for start in range(0, len(run), _RUN))


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
            num_pictures=stream.frames,
            duration=duration,
            promised_end=-math.inf if counts else start + duration - slack,
        )


def _find_start(stream: Any, first: Picture) -> float:
    """Give the time of the first picture [s], even if others had to be decoded before one came."""
    time = picture_time(first.decoded)
    if first.number > 0 and stream.start_time is not None:
        return float(stream.start_time * stream.time_base)
    return 0.0 if math.isnan(time) else time
