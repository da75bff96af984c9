"""Which picture of a video comes when, known without decoding it."""

from collections.abc import Iterator
from contextlib import closing
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import Any

import av
import numpy as np

from ..types.arrays import Scalars
from .container import demux_video, is_avi, open_video, picture_ticks
from .decode import Loss, Picture, decode_pictures, picture_time, renumber

_UNEVEN = 0.5
"""Share of the usual step by which steps may differ; beyond it, packets may have been lost."""
_BACK = (0.0, 2.0, 10.0)
"""How long before a picture its keyframe is looked for [s]; then the file is decoded whole."""


@dataclass(frozen=True, eq=False)
class VideoIndex:
    """The times of all pictures of a video, from which any of them can be started at."""

    times: Scalars
    """Time of each picture in the container, in order [s]."""

    def number_of(self, time: float) -> int:
        """Give the number of the picture that comes at a time of the container [s]."""
        after = int(np.clip(np.searchsorted(self.times, time), 1, len(self.times) - 1))
        return after - int(time - self.times[after - 1] < self.times[after] - time)


def index_video(path: Path) -> VideoIndex | None:
    """Find the time of every picture; None where packets lack times, or some may be lost.

    MP4 and AVI have a table of all packets, of others each packet's head is read. Where steps are
    uneven a count from the beginning may differ, since damage may have swallowed packets: then
    only decoding from there is exact.
    """
    with closing(open_video(path)) as container:
        try:
            times = _avi_times(container) if is_avi(container) else _table_times(container)
            times = _packet_times(container) if times is None else times
        except av.error.FFmpegError:
            return None
    if times is None or len(times) < 2:
        return None
    steps = np.diff(times)
    usual = float(np.median(steps))
    is_even = bool((np.abs(steps - usual) < _UNEVEN * usual).all())
    return VideoIndex(times) if is_even and usual > 0 else None


def decode_from(container: Any, index: VideoIndex | None, number: int) -> Iterator[Picture | Loss]:
    """Decode a video such that a picture and all after it come; some before it may come, too.

    Args:
        container: The video, just opened.
        index: Its index; None: it is decoded from its beginning.
        number: Number of the picture, from 0.
    """
    if index is not None and 0 < number < len(index.times):
        for back in _BACK:
            items = _decode_at(container, index, float(index.times[number]) - back)
            first = next((item for item in items if isinstance(item, Picture)), None)
            if first is not None and first.number <= number:
                return chain([first], items)
        container.seek(0, stream=container.streams.video[0])
    return decode_pictures(container)


def _decode_at(container: Any, index: VideoIndex, time: float) -> Iterator[Picture | Loss]:
    """Decode from the keyframe before a time [s], with numbers as from the beginning."""
    stream = container.streams.video[0]
    unit = float(stream.time_base)
    try:
        container.seek(round(time / unit), stream=stream)
    except av.error.FFmpegError:
        return
    held: list[Picture | Loss] = []
    base: int | None = None
    for item in decode_pictures(container, count_before=lambda pts: index.number_of(pts * unit)):
        held.append(item)
        if base is None and isinstance(item, Picture):
            base = index.number_of(picture_time(item.decoded)) - item.number
        if base is not None:
            yield from (renumber(one, base) for one in held)
            held = []


def _avi_times(container: Any) -> Scalars | None:
    """Give the times of all places of an AVI, those without data too."""
    stream, tick = container.streams.video[0], picture_ticks(container)
    if not tick or not stream.frames:
        return None
    first = next(demux_video(container)).pts
    container.seek(0, stream=stream)
    count = stream.frames // tick
    return None if first is None else (first + tick * np.arange(count)) * float(stream.time_base)


def _table_times(container: Any) -> Scalars | None:
    """Give the times by the file's table of packets, where it lists all, evenly."""
    stream = container.streams.video[0]
    entries = stream.index_entries
    if not stream.frames or len(entries) != stream.frames:
        return None
    decoded = np.array([entry.timestamp for entry in entries], float)
    steps = np.diff(decoded)
    first = next(demux_video(container)).pts
    container.seek(0, stream=stream)
    # Pictures are reordered in even steps if they are decoded in such.
    if first is None or len(steps) == 0 or not (steps == steps[0]).all():
        return None
    return (first + steps[0] * np.arange(len(decoded))) * float(stream.time_base)


def _packet_times(container: Any) -> Scalars | None:
    """Give the times by reading all packets."""
    ticks = []
    for packet in demux_video(container):
        if packet.size == 0:
            continue
        if packet.pts is None or packet.is_corrupt:
            return None
        ticks.append(packet.pts)
    return np.sort(np.array(ticks, float)) * float(container.streams.video[0].time_base)
