"""Light that shows shape: from the upper left, darker in hollows."""

import cv2
import numpy as np
from jaxtyping import Float32

from ..types.arrays import Ratios
from .window import SAMPLES, Depths, Relief

PixelValues = Float32[np.ndarray, "rows columns"]

_KEY = np.array([-0.52, -0.62, -0.59], np.float32)
"""Towards the main light: the upper left of the picture, in front."""
_AMBIENT, _KEY_LIGHT, _HEAD_LIGHT = 0.22, 0.74, 0.10
_WRAP = 2
"""Power of the main light's fall-off: it reaches round to the far side, where no slope is black."""
_HOLLOW_RADII = (3, 9, 27)
"""Radii over which a hollow is looked for [px]."""
_DARKEST = 0.4
"""Share of the light that a hollow may lose."""


def light_up(relief: Relief) -> Ratios:
    """Find how bright each sample is that shows something, about 0 to 1.

    References:
        Luft, Colditz, Deussen, Image enhancement by unsharp masking the depth buffer, SIGGRAPH 2006
        (the hollows).
    """
    key = (0.5 + 0.5 * np.clip(relief.normals @ _KEY, -1, 1)) ** _WRAP
    head = np.maximum(-relief.normals[:, 2], 0)
    light = _AMBIENT + _KEY_LIGHT * key + _HEAD_LIGHT * head
    return light * (1 - _find_hollows(relief))


def _find_hollows(relief: Relief) -> Ratios:
    """Compare each pixel's depth with the mean around it: how much light a hollow loses there."""
    share, depth = _as_pixels(relief.depth)
    lost = np.zeros(depth.shape, np.float32)
    for radius in _HOLLOW_RADII:
        near = _blur(share, radius)
        around = _blur(depth * share, radius) / np.maximum(near, np.float32(1e-6))
        # Beside the background the mean is of one side only, and would darken every rim.
        lost += np.clip((depth - around) / (radius * SAMPLES), 0, 1) * np.clip(2 * near - 1, 0, 1)
    rows, columns = relief.seen.T // SAMPLES
    return np.float32(_DARKEST) * np.minimum(lost, 1)[rows, columns]


def _as_pixels(depth: Depths) -> tuple[PixelValues, PixelValues]:
    """Give the share of each pixel's samples that show something, and their mean depth."""
    size = depth.shape[1] // SAMPLES, depth.shape[0] // SAMPLES
    shows = np.isfinite(depth)
    share = cv2.resize(shows.astype(np.float32), size, interpolation=cv2.INTER_AREA)
    filled = np.where(shows, depth, np.float32(0))
    total = cv2.resize(filled, size, interpolation=cv2.INTER_AREA)
    return share, total / np.maximum(share, np.float32(1e-6))


def _blur(image: np.ndarray, radius: int) -> np.ndarray:
    """Blur by three box filters, which is near a Gaussian at a fraction of its cost."""
    size = 2 * radius + 1
    for _ in range(3):
        image = cv2.blur(image, (size, size), borderType=cv2.BORDER_REFLECT)
    return image
