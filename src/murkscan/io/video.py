"""Videos written from pictures, through FFmpeg."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from fractions import Fraction
from pathlib import Path
from typing import Any, Literal

import av
import numpy as np

from ..errors import DeviceError, InputError
from .atomic import replacing

VideoCodec = Literal["ffv1", "h264", "h265", "mjpeg"]
_ENCODERS = {"ffv1": "ffv1", "h264": "libx264", "h265": "libx265", "mjpeg": "mjpeg"}
_FORMATS = {"h264": "yuv420p", "h265": "yuv420p", "mjpeg": "yuvj420p"}
"""Of those that keep colour at half the resolution."""
LOSSLESS = {"level": "3", "slices": "4", "slicecrc": "1", "g": "1"}
"""FFV1's options: slices of their own let a damaged file lose little, and several cores work at
once."""
_CONTAINERS = {".mp4": "mp4"}
_TICKS = 90_000
"""Ticks a second of the times; the container rounds them to milliseconds."""


@contextmanager
def writing_video(
    path: Path,
    size: tuple[int, int],
    *,
    rate: float,
    codec: VideoCodec,
    crf: int = 23,
    bitrate: float | None = None,
    quality: int = 5,
    streamed: bool = False,
    interlaced: bool = False,
    is_colour: bool = False,
) -> Iterator[Callable[[np.ndarray, float], None]]:
    """Write pictures as a video that appears whole or not at all: MP4 by its suffix, else Matroska.

    Args:
        path: Where the video shall be.
        size: Width and height of the pictures [px].
        rate: Pictures a second, for players; each picture has its own time.
        codec: FFV1, which loses nothing, or H.264, H.265 or MJPEG, whose luma is the grey level.
        crf: Quality of H.264 and H.265: 0 is best, 51 worst.
        bitrate: Bits a second of H.264 and H.265, in place of their quality [1/s].
        quality: Quantiser of MJPEG: 1 is best, 31 worst.
        streamed: Whether H.264 and H.265 are encoded as a camera streams them: in haste, without a
            look at later pictures.
        interlaced: Whether pictures hold two fields, the upper one first; H.264 then codes them so.
        is_colour: Whether pictures are red, green, blue rather than grey.

    Yields:
        A function that adds a picture (8 bit, h w or h w 3) and its time [s].

    Raises:
        InputError: A codec with colour at half the resolution is asked to keep pictures of odd
            width or height.
        DeviceError: The disk is full or cannot be written.

    References:
        ITU-T H.264, H.265 and T.81 (JPEG); RFC 9043 (FFV1).
    """
    if codec in _FORMATS and (size[0] % 2 or size[1] % 2):
        raise InputError(
            f"sensor.codec {codec} keeps pictures of even width and height, not {size[0]} x "
            f"{size[1]}."
        )
    with replacing(path) as aside, _open(path, aside) as container:
        stream = container.add_stream(_ENCODERS[codec], rate=Fraction(rate).limit_denominator(1001))
        stream.width, stream.height = size
        stream.pix_fmt = _FORMATS.get(codec, "bgr0" if is_colour else "gray")
        stream.time_base = stream.codec_context.time_base = Fraction(1, _TICKS)
        stream.codec_context.options = (
            _options(codec, interlaced) | _rate(codec, crf, bitrate, quality) | _haste(streamed)
        )

        def write(picture: np.ndarray, time: float) -> None:
            frame = _as_frame(picture, stream.pix_fmt)
            frame.pts, frame.time_base = round(time * _TICKS), Fraction(1, _TICKS)
            container.mux(stream.encode(frame))

        yield write
        container.mux(stream.encode())


@contextmanager
def _open(path: Path, aside: Path) -> Iterator[Any]:
    try:
        with av.open(
            str(aside), "w", format=_CONTAINERS.get(path.suffix.lower(), "matroska")
        ) as container:
            yield container
    except av.error.FFmpegError as error:
        raise DeviceError(f"Cannot write {path}: {error.strerror}. Make room.") from error


def _options(codec: VideoCodec, interlaced: bool) -> dict[str, str]:
    """Give one thread to each encoder, so that the same pictures give the same bytes everywhere."""
    if codec == "ffv1":
        return LOSSLESS
    if codec == "h265":
        return {"preset": "medium", "x265-params": "pools=none:frame-threads=1:log-level=none"}
    if codec == "mjpeg":
        return {"threads": "1"}
    fields = {"flags": "+ilme+ildct", "x264-params": "tff=1"} if interlaced else {}
    return {"preset": "medium", "threads": "1", **fields}


def _haste(streamed: bool) -> dict[str, str]:
    return {"preset": "ultrafast", "tune": "zerolatency"} if streamed else {}


def _rate(codec: VideoCodec, crf: int, bitrate: float | None, quality: int) -> dict[str, str]:
    """Say how many bits a picture may take; those of a rate may be spread over a second."""
    if codec == "ffv1":
        return {}
    if codec == "mjpeg":
        return {"qmin": str(quality), "qmax": str(quality)}
    if bitrate is None:
        return {"crf": str(crf)}
    bits = str(round(bitrate))
    return {"b": bits, "maxrate": bits, "bufsize": bits}


def _as_frame(picture: np.ndarray, pix_fmt: str) -> Any:
    if picture.ndim == 3:
        return av.VideoFrame.from_ndarray(np.ascontiguousarray(picture), "rgb24").reformat(
            format=pix_fmt
        )
    if pix_fmt == "gray":
        return av.VideoFrame.from_ndarray(np.ascontiguousarray(picture), "gray")
    # The grey levels themselves are the luma: a conversion would squeeze them.
    flat = np.full((picture.shape[0] // 2, picture.shape[1]), 128, np.uint8)
    return av.VideoFrame.from_ndarray(np.concatenate([picture, flat]), pix_fmt)
