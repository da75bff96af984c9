"""Pictures out of a video file, with a word about those that cannot be decoded."""

import heapq
import math
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from statistics import median
from typing import Any, Literal

import av
import numpy as np

from ..types.arrays import Image
from .colour import AbstractColour
from .container import demux_video, is_avi, picture_ticks

_MOST_REORDERED = 16
"""Pictures that an encoder may put before one that is shown earlier (H.264, max_num_reorder)."""


@dataclass(frozen=True, eq=False)
class Picture:
    """A picture that could be decoded."""

    number: int
    """Its number in the recording, counted with those that are lost."""
    decoded: Any
    """What PyAV decoded."""


@dataclass(frozen=True)
class Loss:
    """Pictures in a row that give no frames."""

    first: int
    """Number of the first of them in the recording."""
    count: int
    """How many they are."""
    why: Literal["broken", "empty", "cut", "untimed"] = "broken"
    """They cannot be decoded, have no data in the file, are promised behind the file's end, or have
    no time of their own."""

    @property
    def end(self) -> int:
        """Number of the first picture after them."""
        return self.first + self.count


def decode_pictures(
    container: Any, *, count_before: Callable[[int], int] = lambda _: 0
) -> Iterator[Picture | Loss]:
    """Decode a container from its present place; numbers count from 0 there.

    A picture that the decoder gives up, or marks as patched up from others, is a loss. Lost
    pictures keep their numbers: those of the packets that were fed and never came out, or, where
    damage swallowed packets too, as many as fit into the gap in time.

    Args:
        container: What `open_video` gives.
        count_before: Gives how many pictures come before one by its time [ticks], where the present
            place is not the beginning.
    """
    tick = picture_ticks(container)
    fed, rhythm = _Fed(tick), _Rhythm(tick)
    number, lost, damaged = 0, 0, True
    for decoded in _decode_packets(container, fed):
        if decoded is None:
            damaged = True
            continue
        missing = fed.forget_until(decoded.pts)
        # Without damage an odd packet is no lost picture: two fields may come in two packets.
        lost += missing if damaged else 0
        if decoded.is_corrupt:
            lost, damaged = lost + 1, True
            continue
        lost = max(lost, rhythm.beat(decoded.pts, damaged))
        if lost:
            yield Loss(number, lost, "broken" if damaged or not tick else "empty")
        yield Picture(number + lost, decoded)
        number, lost, damaged = number + lost + 1, 0, False
    promised = container.streams.video[0].frames // max(tick, 1) - fed.num_pictures
    if fed.first is not None:
        promised -= count_before(fed.first) - fed.num_leading
    lost += len(fed.times) if damaged or promised > 0 else 0
    if lost:
        yield Loss(number, lost)
    if promised > 0:
        yield Loss(number + lost, promised, "cut")


class _Fed:
    """The packets that the decoder was fed."""

    def __init__(self, tick: int) -> None:
        self._tick = tick
        self._count = 0
        self.first: int | None = None
        """Time of the first of them."""
        self.num_leading = 0
        """How many are shown before the first one: they lean on what comes before it."""
        self._last = 0
        self.times: list[int] = []
        """A heap: the times of those whose pictures have not come out."""

    @property
    def num_pictures(self) -> int:
        """How many pictures they stand for; in AVI those without a packet count as well."""
        if self._tick and self.first is not None:
            return (self._last - self.first) // self._tick + 1
        return self._count

    def add(self, packet: Any) -> None:
        """Note a packet; the empty one at the end is none."""
        self._count += packet.dts is not None or packet.size > 0
        if packet.pts is not None:
            self.first = packet.pts if self.first is None else self.first
            self.num_leading += packet.pts < self.first
            self._last = max(self._last, packet.pts)
            heapq.heappush(self.times, packet.pts)

    def forget_until(self, pts: int | None) -> int:
        """Forget a picture that came out, and all before it; count those before it.

        Pictures come out in order of time, so what is earlier has been given up by the decoder.
        """
        missing = 0
        while pts is not None and self.times and self.times[0] <= pts:
            missing += heapq.heappop(self.times) < pts
        return missing


class _Rhythm:
    """How far pictures are apart, by those that were decoded lately."""

    def __init__(self, tick: int) -> None:
        self._tick = tick
        self._last: int | None = None
        self._steps: deque[int] = deque(maxlen=25)

    def beat(self, pts: int | None, damaged: bool) -> int:
        """Note the next good picture; if there was damage before it, say how many fit between."""
        step = None if pts is None or self._last is None else pts - self._last
        self._last = pts
        if step is None or step <= 0:
            return 0
        if self._tick:
            return max(round(step / self._tick) - 1, 0)
        if not damaged:
            self._steps.append(step)
        if not damaged or not self._steps:
            return 0
        return max(round(step / median(self._steps)) - 1, 0)


def _decode_packets(container: Any, fed: _Fed) -> Iterator[Any]:
    """Feed packets and give what comes out in order of time, None for damage."""
    decoded = _feed(container, fed)
    return _sort_times(decoded) if is_avi(container) else decoded


def _sort_times(decoded: Iterator[Any]) -> Iterator[Any]:
    """Give pictures of AVI the times of their places.

    AVI knows when packets are decoded, not when pictures are shown. A decoder gives pictures in the
    order in which they are shown, each with the time of its packet: the first one is shown at the
    earliest of these times, and so on.
    """
    waiting, times = deque[Any](), list[int]()
    for item in decoded:
        waiting.append(item)
        if item is not None and item.pts is not None:
            heapq.heappush(times, item.pts)
        if len(times) > _MOST_REORDERED:
            yield from _release(waiting, times)
    while waiting:
        yield from _release(waiting, times)


def _release(waiting: deque[Any], times: list[int]) -> Iterator[Any]:
    """Give what waits, up to the first picture with a time."""
    while waiting:
        item = waiting.popleft()
        if item is not None and item.pts is not None:
            item.pts = heapq.heappop(times)
            yield item
            return
        yield item


def _feed(container: Any, fed: _Fed) -> Iterator[Any]:
    packets = demux_video(container)
    while True:
        try:
            packet = next(packets, None)
        except av.error.FFmpegError:
            yield None
            return
        if packet is None:
            return
        fed.add(packet)
        if packet.is_corrupt:
            yield None
        try:
            yield from packet.decode()
        except av.error.FFmpegError:
            yield None


def renumber(item: Picture | Loss, base: int) -> Picture | Loss:
    """Count an item from another beginning."""
    if isinstance(item, Loss):
        return replace(item, first=item.first + base)
    return replace(item, number=item.number + base)


def picture_time(decoded: Any) -> float:
    """Give the container's time of a picture [s]; NaN where it has none."""
    return math.nan if decoded.pts is None else float(decoded.pts * decoded.time_base)


def grey_from_video(decoded: Any, colour: AbstractColour) -> Image:
    """Give a decoded picture as grey levels of 8 bit, or of up to 16 in 16.

    YUV with a green laser gives the Y plane as it is: chroma has half the resolution, and
    stretching a limited range would only add rounding.

    Args:
        decoded: What PyAV decoded.
        colour: How colours become grey levels.
    """
    form = decoded.format
    luma = not (form.is_rgb or form.is_bayer or form.has_palette)
    if luma and (colour.is_luma or len(form.components) < 3):
        return colour.grey(_luma(decoded))
    # A Bayer format counts the bits of its pattern of four in three odd parts.
    deep = form.bits_per_pixel > 8 if form.is_bayer else form.components[0].bits > 8
    return colour.grey(decoded.to_ndarray(format="rgb48le" if deep else "rgb24"))


def _luma(decoded: Any) -> Image:
    """Give the Y plane, unpacked where it is not a plane of its own; every value is kept."""
    form = decoded.format
    bits = form.components[0].bits
    if form.is_big_endian:
        decoded = decoded.reformat(format=form.name[:-2] + "le")
    if bits < 8 or form.name.startswith("ya"):
        decoded = decoded.reformat(format="gray" if bits <= 8 else "gray16le")
    elif form.name.startswith("p") or any(part.plane == 0 for part in form.components[1:]):
        # P010 and its like keep their bits in the upper part of a word; this shifts them down.
        decoded = decoded.reformat(format="yuv444p" if bits == 8 else f"yuv444p{bits}le")
    plane = decoded.planes[0]
    values = np.frombuffer(plane, np.uint8 if bits <= 8 else np.uint16)
    return values.reshape(plane.height, -1)[:, : plane.width].copy()
