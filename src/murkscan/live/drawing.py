"""The newest picture, small enough to be shown while the next one comes."""

import cv2
import numpy as np

from ..types.arrays import ColourImage, Pixels
from ..types.frame import Frame

_WIDEST = 960
"""Width up to which pictures are shown [px]."""
_GREEN = (0, 230, 120)
_DIMMEST, _BRIGHT = 64.0, 200.0
"""Level from which a picture is brightened, under a stripe, so that this is its brightest part, and
that level [grey levels]; as the scan's overlays."""


def draw_picture(frame: Frame, stripe: Pixels | None = None) -> ColourImage:
    """Draw a frame, a field at the height of its full frame.

    With stripe centres over it a dark one is brightened.

    Args:
        frame: The frame.
        stripe: Centres in pixels of the full frame [px]; None: the picture as it came.
    """
    height, width = frame.image.shape[0] * frame.row_step, frame.image.shape[1]
    scale = min(_WIDEST / width, 1.0)
    deep = frame.image.dtype == np.uint16
    # Deep pictures use the upper bits of what they have; 12 bits in 16 are common.
    shift = max(int(frame.image.max(initial=0)).bit_length() - 8, 0) if deep else 0
    grey = (frame.image >> shift).astype(np.uint8)
    size = (max(round(width * scale), 1), max(round(height * scale), 1))
    small = cv2.resize(grey, size, interpolation=cv2.INTER_AREA if scale < 1 else cv2.INTER_LINEAR)
    if stripe is None:
        return cv2.cvtColor(small, cv2.COLOR_GRAY2RGB)
    top = max(float(np.quantile(small, 0.999)), _DIMMEST)
    bright = np.clip(small * (_BRIGHT / top), 0, 255).astype(np.uint8)
    picture = cv2.cvtColor(bright, cv2.COLOR_GRAY2RGB)
    if len(stripe):
        u, v = np.rint((stripe + 0.5) * scale - 0.5).astype(int).T
        inside = (u >= 0) & (u < size[0]) & (v >= 0) & (v < size[1])
        picture[v[inside], u[inside]] = _GREEN
        below = np.minimum(v[inside] + 1, size[1] - 1)
        picture[below, u[inside]] = _GREEN
    return picture
