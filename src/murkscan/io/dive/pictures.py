"""Pictures in messages: video packet by packet, compressed pictures, raw ones."""

import base64
import binascii
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...errors import FormatError
from .messages import Topic, look_up, read_stamp

_TYPES = ("CompressedVideo", "CompressedImage", "Image", "RawImage")
VIDEO = {"h264": "h264", "h265": "hevc", "hevc": "hevc", "av1": "av1", "vp9": "vp9"}
"""FFmpeg's names of decoders, by the names that recorders give."""
_STILL = ("jpeg", "jpg", "png", "webp")
RAW = {
    "mono8": (np.uint8, 1, "grey"), "8uc1": (np.uint8, 1, "grey"),
    "mono16": (np.uint16, 1, "grey"), "16uc1": (np.uint16, 1, "grey"),
    "rgb8": (np.uint8, 3, "rgb"), "bgr8": (np.uint8, 3, "bgr"), "8uc3": (np.uint8, 3, "bgr"),
    "rgba8": (np.uint8, 4, "rgb"), "bgra8": (np.uint8, 4, "bgr"),
    "rgb16": (np.uint16, 3, "rgb"), "bgr16": (np.uint16, 3, "bgr"),
    "bayer_rggb8": (np.uint8, 1, "RG"), "bayer_bggr8": (np.uint8, 1, "BG"),
    "bayer_gbrg8": (np.uint8, 1, "GB"), "bayer_grbg8": (np.uint8, 1, "GR"),
    "bayer_rggb16": (np.uint16, 1, "RG"), "bayer_bggr16": (np.uint16, 1, "BG"),
    "bayer_gbrg16": (np.uint16, 1, "GB"), "bayer_grbg16": (np.uint16, 1, "GR"),
    "yuv422": (np.uint8, 2, "uyvy"), "uyvy": (np.uint8, 2, "uyvy"),
    "yuv422_yuy2": (np.uint8, 2, "yuyv"), "yuyv": (np.uint8, 2, "yuyv"),
}  # fmt: skip
"""Encodings of raw pictures: type and channels of a pixel, and what they are."""


@dataclass(frozen=True, eq=False)
class PictureMessage:
    """What a message of a camera holds."""

    codec: str
    """A key of VIDEO, `still`, a key of RAW, or what the message says and nobody reads."""
    data: bytes
    stamp: int | None
    """The message's own time [ns]."""
    size: tuple[int, int] = (0, 0)
    """Width and height of a raw picture [px]."""
    step: int = 0
    """Bytes of one of its rows."""
    is_big_endian: bool = False

    @property
    def is_readable(self) -> bool:
        """Tell whether there is something that decodes it."""
        return self.codec in VIDEO or self.codec == "still" or self.codec in RAW

    @property
    def is_key(self) -> bool | None:
        """Tell whether decoding can start here; None where nothing here knows."""
        if self.codec not in VIDEO:
            return True
        return _is_key(self.codec, self.data)

    def as_array(self) -> np.ndarray:
        """Give a raw picture as h w, or h w 3 in the order red, green, blue.

        Raises:
            FormatError: It has fewer bytes than its size needs.
        """
        import cv2

        kind, channels, meaning = RAW[self.codec]
        (width, height), item = self.size, np.dtype(kind).itemsize
        step = self.step or width * channels * item
        if len(self.data) < step * height or step < width * channels * item:
            raise FormatError(f"a raw picture has {len(self.data)} bytes, too few for its size")
        rows = np.frombuffer(self.data, np.uint8, step * height).reshape(height, step)
        image = np.ascontiguousarray(rows[:, : width * channels * item]).view(kind)
        image = image.byteswap() if self.is_big_endian and item == 2 else image
        image = image.reshape(height, width, channels)
        if meaning == "grey":
            return image[:, :, 0].copy()
        if meaning in ("uyvy", "yuyv"):
            # The luma as it stands; of a laser that is not green the colour has half of the rows.
            return image[:, :, 1 if meaning == "uyvy" else 0].copy()
        if meaning in ("rgb", "bgr"):
            return np.ascontiguousarray(image[:, :, :3] if meaning == "rgb" else image[:, :, 2::-1])
        # OpenCV names a pattern by its second row and column, ROS by its first.
        patterns = {"RG": "BG", "BG": "RG", "GB": "GR", "GR": "GB"}
        return cv2.cvtColor(image[:, :, 0], getattr(cv2, f"COLOR_Bayer{patterns[meaning]}2RGB"))


def may_hold_pictures(topic: Topic, first: Any) -> bool:
    """Tell whether a topic is a camera's, by its type and its first message."""
    if topic.kind in _TYPES:
        return True
    return (
        isinstance(first, Mapping)
        and isinstance(first.get("format"), str)
        and isinstance(first.get("data"), str | Sequence)
    )


def read_picture(topic: Topic, value: Any) -> PictureMessage:
    """Find out what a decoded message of a camera holds.

    Raises:
        FormatError: It holds no picture.
    """
    data = _as_bytes(look_up(value, "data"))
    stamp = read_stamp(look_up(value, "timestamp") or look_up(value, "header.stamp"))
    form, encoding = look_up(value, "format"), look_up(value, "encoding")
    if data is None or not isinstance(form if form is not None else encoding, str):
        raise FormatError(f"a message of {topic.name} holds no picture")
    if form is not None:
        return PictureMessage(_codec(form, data), data, stamp)
    size = (int(look_up(value, "width") or 0), int(look_up(value, "height") or 0))
    return PictureMessage(
        str(encoding).lower(), data, stamp, size,
        int(look_up(value, "step") or 0), bool(look_up(value, "is_bigendian")),
    )  # fmt: skip


def _as_bytes(data: Any) -> bytes | None:
    """Give the bytes of a field: base64 or numbers in JSON, an array in ROS."""
    try:
        if isinstance(data, str):
            return base64.b64decode(data, validate=True)
        if isinstance(data, np.ndarray):
            return data.tobytes()
        return None if data is None else bytes(data)
    except (binascii.Error, ValueError, TypeError):
        return None


def _codec(form: str, data: bytes) -> str:
    words = form.lower().replace(";", " ").split()
    found = next((word for word in words if word in VIDEO), None)
    if found is not None:
        return found
    is_still = any(word in _STILL for word in words) and "compresseddepth" not in words
    return "still" if is_still or data[:2] == b"\xff\xd8" else form


def _is_key(codec: str, data: bytes) -> bool | None:
    """Tell whether a packet begins a group of pictures, by the units in front of its first slice.

    References:
        ITU-T H.264, table 7-1; H.265, table 7-1: the types of units.
    """
    if codec not in ("h264", "h265", "hevc"):
        return None
    at = data.find(b"\0\0\1")
    while 0 <= at < len(data) - 3:
        unit = data[at + 3] & 0x1F if codec == "h264" else data[at + 3] >> 1 & 0x3F
        if codec == "h264" and 1 <= unit <= 5:
            return unit == 5
        if codec != "h264" and unit < 32:
            return 16 <= unit <= 21
        at = data.find(b"\0\0\1", at + 3)
    return False
