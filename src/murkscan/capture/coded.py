"""The data of a stream's pictures, handed on while they are recorded."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from .growing import TICKS


@dataclass(frozen=True)
class PictureCodec:
    """What a decoder must know before the first picture."""

    name: str
    """As FFmpeg calls it."""
    extra: bytes | None
    """What the stream says of itself beside its pictures."""

    @classmethod
    def of(cls, context: Any) -> "PictureCodec":
        """Read it from PyAV's codec context."""
        extra = context.extradata
        return cls(context.name, None if extra is None else bytes(extra))


@dataclass(frozen=True)
class CodedPicture:
    """One packet of a stream: a picture, or a field, as the camera coded it."""

    codec: PictureCodec
    data: bytes
    time: float
    """When it is shown, in the recording's time [s]."""
    is_keyframe: bool
    arrived: float
    """When it came, by `time.monotonic` [s]."""

    @classmethod
    def of(cls, packet: Any, codec: PictureCodec) -> "CodedPicture":
        """Copy a packet whose times have been placed in the recording."""
        return cls(codec, bytes(packet), packet.pts / TICKS, packet.is_keyframe, time.monotonic())


Tap = Callable[[CodedPicture], None]
"""Is given each picture as it comes; must not wait."""


def tell_nobody(picture: CodedPicture) -> None:
    """Let the pictures pass."""
