"""Recording pictures losslessly into a file, with the times at which they came."""

from collections.abc import Callable, Generator, Iterable
from fractions import Fraction
from pathlib import Path
from typing import Any

import av
import numpy as np

from ..errors import DeviceError
from ..io.video import LOSSLESS
from .growing import TICKS, RecordingProgress, growing_video

_FORMATS = {
    (2, "uint8"): ("gray", "gray"),
    (2, "uint16"): ("gray16le", "gray16le"),
    (3, "uint8"): ("rgb24", "bgr0"),
}
"""From the picture's axes and depth to PyAV's name for it, and the codec's that keeps all bits."""


def record_images(
    images: Iterable[tuple[np.ndarray, float]],
    out: Path,
    *,
    seconds: float | None = None,
    begin: Callable[[], float] = lambda: 0.0,
) -> Generator[RecordingProgress, None, None]:
    """Write pictures into a Matroska file, compressed without loss (FFV1).

    Closing the iterator, or an interrupt, ends the recording and leaves a file that plays.

    Args:
        images: Pictures (h w in 8 or 16 bit, or h w 3 red, green, blue in 8 bit) and the times at
            which they came [s], increasing; the first becomes 0.
        out: Where the file shall be; nothing may stand there.
        seconds: Length of the recording [s]; without it, to the end of the pictures.
        begin: Asked once, when the first picture comes: the time that it shall have [s].

    Yields:
        What is written so far, after each picture.

    Raises:
        InputError: A file stands at `out`.
        DeviceError: A picture has another size than the first, or the camera or the disk fails;
            what came is kept.

    References:
        Niedermayer, Rice, Martinez, FFV1 Video Coding Format Versions 0, 1, and 3, RFC 9043.
    """
    with growing_video(out) as container:
        stream, first, last, size, start = None, None, -1, 0, 0.0
        for frames, (image, time) in enumerate(images, start=1):
            if first is None:
                first, start = time, begin()
            if seconds is not None and time - first >= seconds:
                break
            stream = stream or _add_stream(container, image)
            last = max(round((start + time - first) * TICKS), last + 1)
            for packet in stream.encode(_picture(image, stream, last)):
                size += packet.size
                container.mux(packet)
            yield RecordingProgress(frames, last / TICKS, size)
        if stream is not None:
            container.mux(stream.encode())


def _add_stream(container: Any, image: np.ndarray) -> Any:
    stream = container.add_stream("ffv1", rate=TICKS)
    stream.height, stream.width = image.shape[:2]
    stream.pix_fmt = _FORMATS[image.ndim, image.dtype.name][1]
    stream.time_base = stream.codec_context.time_base = Fraction(1, TICKS)
    stream.codec_context.options = LOSSLESS
    stream.thread_type = "SLICE"
    return stream


def _picture(image: np.ndarray, stream: Any, ticks: int) -> Any:
    if image.shape[:2] != (stream.height, stream.width):
        raise DeviceError(
            f"The camera's pictures changed from {stream.width} x {stream.height} to "
            f"{image.shape[1]} x {image.shape[0]} px while recording; start anew."
        )
    given, kept = _FORMATS[image.ndim, image.dtype.name]
    picture = av.VideoFrame.from_ndarray(np.ascontiguousarray(image), given).reformat(format=kept)
    picture.pts, picture.time_base = ticks, Fraction(1, TICKS)
    return picture
