"""What a recorder makes of a camera's pictures before anybody sees them: it smooths and encodes."""

from dataclasses import dataclass
from typing import Literal, get_args

import cv2
import numpy as np

from ..errors import InputError
from ..types.arrays import Image

Codec = Literal["png", "ffv1", "h264", "h265", "mjpeg"]

_CHANGE = 0.024
"""Change between pictures that counts as noise, as a share of white: 6 of 255 grey levels."""
_STREAMED = ("h264", "h265")
_BOUNDS = (("crf", 0, 51), ("quality", 1, 31), ("denoise", 0, 0.99))


@dataclass(frozen=True)
class Recorder:
    """How pictures are kept."""

    codec: Codec = "png"
    """A folder of pictures, or a video."""
    crf: int = 23
    """Quality of H.264 and H.265, 0 (best) to 51."""
    bitrate: float | None = None
    """Bits a second of H.264 and H.265, in place of a quality [1/s]."""
    quality: int = 5
    """Quality of MJPEG by its quantiser, 1 (best) to 31."""
    streamed: bool = False
    """Whether H.264 and H.265 are encoded while the camera films, as its own chip does."""
    denoise: float = 0.0
    """Share that a picture takes from the one before wherever it has hardly changed."""

    def __post_init__(self) -> None:
        """Refuse a recorder that cannot be."""
        if self.codec not in get_args(Codec):
            raise InputError(f"sensor.codec must be one of {', '.join(get_args(Codec))}.")
        for name, low, high in _BOUNDS:
            if not low <= getattr(self, name) <= high:
                raise InputError(
                    f"sensor.{name} must lie between {low} and {high}, got {getattr(self, name):g}."
                )
        if self.streamed and self.codec not in _STREAMED:
            raise InputError(f"sensor.streamed goes with h264 and h265, not {self.codec}.")
        if self.bitrate is None:
            return
        if self.codec not in _STREAMED:
            raise InputError(f"sensor.bitrate_mbit_s goes with h264 and h265, not {self.codec}.")
        if not 1e4 <= self.bitrate <= 1e9:
            raise InputError(
                f"sensor.bitrate_mbit_s must lie between 0.01 and 1000, got {self.bitrate / 1e6:g}."
            )

    def smooth(self, picture: Image, before: Image | None, white: int) -> Image:
        """Average a picture with the one kept before it, where the two hardly differ.

        Args:
            picture: As the camera gives it; of an interlaced one both fields, so that each is
                compared with the field of the same rows.
            before: What was kept last; None: nothing.
            white: The highest grey level.

        References:
            Dubois and Sabri, Noise reduction in image sequences using motion-compensated temporal
            filtering, IEEE Transactions on Communications 32(7), 1984 (recursive filter whose
            share falls with the change).
        """
        if before is None or self.denoise == 0:
            return picture
        change = picture.astype(np.float32) - before
        seen = cv2.blur(np.abs(change), (3, 3)) / (_CHANGE * white)
        share = np.float32(self.denoise) * np.exp(-(seen**2))
        return np.rint(picture - share * change).astype(picture.dtype)
