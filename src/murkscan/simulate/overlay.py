"""What a camera or a recorder writes over its pictures: text, and a frame around them."""

from dataclasses import dataclass

import cv2
import numpy as np

from ..errors import InputError
from ..optics.sensor import Picture
from ..types.arrays import Image

_FONT = cv2.FONT_HERSHEY_SIMPLEX
_SIZE = 22.0
"""Height of this font's capitals at scale 1 [px]."""
_MARGIN = 12
"""From the picture's edge to the text [px]."""
_BRIGHT = 0.92
"""Share of white that letters have; their rim is black."""


@dataclass(frozen=True)
class Overlay:
    """On-screen text, and a frame as many industrial cameras' files have."""

    text: tuple[str, ...] = ()
    """Up to four lines, for the corners top left, top right, bottom left, bottom right; in each,
    {time} is the time since the start of the recording."""
    text_height: float = 14.0
    """Height of capitals [px]."""
    border: float | None = None
    """Grey level of a frame of one pixel around the picture; None: there is none."""

    def __post_init__(self) -> None:
        """Refuse what cannot be written."""
        if len(self.text) > 4:
            raise InputError(f"overlay.text has a line for each corner, got {len(self.text)}.")
        if not 5 <= self.text_height <= 500:
            raise InputError(
                f"overlay.text_height_px must lie between 5 and 500, got {self.text_height:g}."
            )
        if self.border is not None and not 0 <= self.border <= 65535:
            raise InputError(
                f"overlay.border_grey must lie between 0 and 65535, got {self.border:g}."
            )

    def draw(self, size: tuple[int, int], time: float, white: int) -> Picture:
        """Give the grey level that is written over each pixel; NaN where the picture stays.

        Args:
            size: Width and height of the picture [px].
            time: Since the start of the recording [s].
            white: The highest grey level.
        """
        width, height = size
        over = np.full((height, width), np.nan, np.float32)
        for corner, line in enumerate(self.text):
            self._write(over, line.replace("{time}", _as_clock(time)), corner, white)
        if self.border is not None:
            over[[0, -1]] = over[:, [0, -1]] = min(self.border, white)
        return over

    def _write(self, over: Picture, line: str, corner: int, white: int) -> None:
        height, width = over.shape
        scale = self.text_height / _SIZE
        stroke = max(round(scale * 2), 1)
        (long, high), _ = cv2.getTextSize(line, _FONT, scale, stroke)
        u = _MARGIN if corner % 2 == 0 else width - _MARGIN - long
        v = _MARGIN + high if corner < 2 else height - _MARGIN
        letters, rim = np.zeros((2, height, width), np.uint8)
        cv2.putText(rim, line, (u, v), _FONT, scale, 255, stroke + 2, cv2.LINE_8)
        cv2.putText(letters, line, (u, v), _FONT, scale, 255, stroke, cv2.LINE_8)
        over[rim > 0] = 0.0
        over[letters > 0] = _BRIGHT * white


def write_over(image: Image, over: Picture) -> Image:
    """Write over a picture of as many rows; what is NaN stays."""
    return np.where(np.isnan(over), image, np.nan_to_num(over)).astype(image.dtype)


def _as_clock(time: float) -> str:
    minutes, seconds = divmod(max(time, 0.0), 60)
    return f"{int(minutes):02d}:{seconds:04.1f}"
