"""Pictures from here and there in a video, without decoding all of it."""

import math
from collections.abc import Iterator, Sequence
from contextlib import closing, suppress
from itertools import islice
from pathlib import Path
from typing import Any

import av

from .container import demux_video, open_video
from .decode import Picture, decode_pictures, picture_time

_NOWHERE = float("-inf")
_SAME = 1e-6
"""Difference below which two times are the same [s]."""


def pictures_at(path: Path, times: Sequence[float]) -> Iterator[Any]:
    """Decode one picture near each of some increasing times [s of the container].

    Where there is a keyframe since the last picture, the last one before the time is given, which
    costs one picture's decoding; otherwise the video is decoded on up to the time. So no part is
    decoded twice. Times whose pictures cannot be decoded are left out, and pictures without a time.
    """
    keyframes = find_keyframes(path, times)
    position = _NOWHERE
    with closing(open_video(path)) as container:
        pictures = _good_pictures(container)
        for time, keyframe in zip(times, keyframes, strict=True):
            jumps = keyframe > position
            if jumps:
                pictures = _restart(container, keyframe)
            for decoded in pictures:
                if math.isnan(picture_time(decoded)):
                    continue
                position = max(position, picture_time(decoded))
                if jumps or position >= time - _SAME:
                    yield decoded
                    break


def read_runs(path: Path, times: Sequence[float], total: int) -> Iterator[list[Any]]:
    """Decode runs of pictures that follow one another, from the keyframes before some times [s].

    Args:
        path: The video.
        times: Where to look, increasing.
        total: How many pictures to decode, all runs together.
    """
    keyframes = sorted(set(find_keyframes(path, times)))
    with closing(open_video(path)) as container:
        for keyframe in keyframes:
            run = islice(_restart(container, keyframe), -(-total // len(keyframes)))
            yield list(run)


def find_keyframes(path: Path, times: Sequence[float]) -> list[float]:
    """Give the time of the keyframe at or before each time [s]; -inf where none is found."""
    found = []
    with closing(open_video(path)) as container:
        for time in times:
            keyframe = _NOWHERE
            with suppress(av.error.FFmpegError):
                _seek(container, time)
                packet = next(demux_video(container))
                if packet.pts is not None and packet.pts * packet.time_base <= time + _SAME:
                    keyframe = float(packet.pts * packet.time_base)
            found.append(keyframe)
    return found


def _seek(container: Any, time: float) -> None:
    stream = container.streams.video[0]
    container.seek(round(time / stream.time_base), stream=stream)


def _restart(container: Any, time: float) -> Iterator[Any]:
    """Decode from the keyframe at a time, or from the beginning where there is none."""
    if time > _NOWHERE:
        with suppress(av.error.FFmpegError):
            _seek(container, time)
    return _good_pictures(container)


def _good_pictures(container: Any) -> Iterator[Any]:
    return (item.decoded for item in decode_pictures(container) if isinstance(item, Picture))
