"""Pictures of a stream as frames, while they come: decoded, made grey, split into fields."""

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import av

from ..types.arrays import Image
from ..types.frame import Frame
from .clock import usual_spacing
from .coded import CodedPicture
from .colour import LaserColour
from .decode import grey_from_video
from .field_order import RUN, RUNS, Fields, decide_order
from .fields import FieldOrder, split_fields
from .growing import TICKS

_LOOK = RUN * RUNS[0]
"""Pictures from which it is told whether they are interlaced."""


@dataclass(frozen=True, eq=False)
class ArrivedPicture:
    """A picture, and when it came."""

    image: Image
    """Grey levels of the whole picture."""
    number: int
    """Its number among those that came, also those that could not be decoded."""
    time: float
    """Recording time [s]."""
    arrived: float
    """When it came, by `time.monotonic` [s]."""
    is_flagged: bool = False
    """Whether it is marked as interlaced."""


@dataclass(frozen=True, eq=False)
class ArrivedFrame:
    """A frame, and when its picture came."""

    frame: Frame
    arrived: float
    """By `time.monotonic` [s]."""


class StreamDecoder:
    """Decodes a stream's pictures as they come; after a gap it waits for a keyframe."""

    def __init__(self, colour: LaserColour) -> None:
        """Begin with nothing.

        Args:
            colour: How colours become grey levels.
        """
        self._colour = colour
        self._context: Any = None
        self._codec: object = None
        self._next = 0
        self._fed: dict[int, tuple[int, float]] = {}

    def decode(self, number: int, coded: CodedPicture) -> list[ArrivedPicture]:
        """Decode one picture; what comes out may be earlier ones, or none.

        Args:
            number: Its number among all that came; a gap tells that some were dropped.
            coded: Its data.
        """
        if number != self._next or coded.codec != self._codec:
            self._context = None
        self._next = number + 1
        if self._context is None:
            if not coded.is_keyframe:
                return []
            self._begin(coded)
        packet = av.Packet(coded.data)
        packet.pts = round(coded.time * TICKS)
        packet.time_base = Fraction(1, TICKS)
        self._fed[packet.pts] = number, coded.arrived
        try:
            return [self._as_arrived(decoded) for decoded in self._context.decode(packet)]
        except av.error.FFmpegError:
            return []

    def _begin(self, coded: CodedPicture) -> None:
        context = av.CodecContext.create(coded.codec.name, "r")
        if coded.codec.extra is not None:
            context.extradata = coded.codec.extra
        context.thread_type = "SLICE"  # threads by pictures would hold some of them back
        self._context, self._codec, self._fed = context, coded.codec, {}

    def _as_arrived(self, decoded: Any) -> ArrivedPicture:
        number, arrived = self._fed.get(decoded.pts, (self._next - 1, 0.0))
        # Those shown earlier have come out already, or never will.
        self._fed = {pts: value for pts, value in self._fed.items() if pts > decoded.pts}
        image = grey_from_video(decoded, self._colour)
        return ArrivedPicture(
            image, number, decoded.pts / TICKS, arrived, bool(decoded.interlaced_frame)
        )


class FrameSplitter:
    """Makes frames of pictures; whether they are fields it tells from the first second."""

    def __init__(self, fields: Fields = "auto") -> None:
        """Begin with what the user says of the fields."""
        self._fields: Fields = fields
        self._first: list[ArrivedPicture] = []
        self.order: FieldOrder | None = None if fields == "auto" else fields
        """What a picture is made of; None while that is being found out."""
        self._period = 0.0

    def split(self, picture: ArrivedPicture) -> Iterator[ArrivedFrame]:
        """Give the frames of a picture, and, when their kind is known, those of the first ones."""
        if self.order is None or not self._period:
            self._first.append(picture)
            if len(self._first) < _LOOK:
                return
            self._decide()
            for one in self._first:
                yield from self._split(one)
            self._first = []
            return
        yield from self._split(picture)

    def _decide(self) -> None:
        images = [one.image for one in self._first]
        runs = [images[start : start + RUN] for start in range(0, _LOOK, RUN)]
        flag: FieldOrder = "top-first" if self._first[0].is_flagged else "progressive"
        self.order = self.order or decide_order(self._fields, lambda count: runs, flag)
        self._period = usual_spacing([[one.time for one in self._first]]) or 1.0

    def _split(self, one: ArrivedPicture) -> Iterator[ArrivedFrame]:
        assert self.order is not None  # decided by now
        frames = split_fields(
            one.image, picture=one.number, time=one.time, period=self._period, order=self.order
        )
        for frame in frames:
            yield ArrivedFrame(frame, one.arrived)
