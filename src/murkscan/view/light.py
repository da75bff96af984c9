"""Light that shows shape: from the upper left, darker in hollows."""

import cv2
import numpy as np

from .window import SAMPLES, Depths, Relief

_KEY = np.array([-0.52, -0.62, -0.59])
"""Towards the main light: the upper left of the picture, in front."""
_AMBIENT, _KEY_LIGHT, _HEAD_LIGHT = 0.22, 0.74, 0.10
_WRAP = 2.0
"""Power of the main light's fall-off: it reaches round to the far side, where no slope is black."""
_HOLLOW_RADII = (3, 9, 27)
"""Radii over which a hollow is looked for [px]."""
_DARKEST = 0.4
"""Share of the light that a hollow may lose."""


def light_up(relief: Relief) -> Depths:
    """Find how bright each sample is, about 0 to 1.

    References:
        Luft, Colditz, Deussen, Image enhancement by unsharp masking the depth buffer, SIGGRAPH 2006
        (the hollows).
    """
    key = (0.5 + 0.5 * np.clip(relief.normals @ _KEY, -1, 1)) ** _WRAP
    head = np.maximum(-relief.normals[..., 2], 0)
    light = _AMBIENT + _KEY_LIGHT * key + _HEAD_LIGHT * head
    return light * (1 - _find_hollows(relief))


def _find_hollows(relief: Relief) -> Depths:
    """Compare each depth with the mean around it: how much light a hollow loses there."""
    seen = relief.seen
    depth = np.where(seen, relief.depth, 0).astype(np.float32)
    weight = seen.astype(np.float32)
    lost = np.zeros(depth.shape, np.float32)
    for radius in _HOLLOW_RADII:
        width = radius * SAMPLES
        share = _blur(weight, width)
        around = _blur(depth, width) / np.maximum(share, 1e-6)
        # Beside the background the mean is of one side only, and would darken every rim.
        lost += np.clip((depth - around) / width, 0, 1) * np.clip(2 * share - 1, 0, 1)
    return np.where(seen, _DARKEST * np.minimum(lost, 1), 0.0)


def _blur(image: np.ndarray, radius: int) -> np.ndarray:
    """Blur by three box filters, which is near a Gaussian at a fraction of its cost."""
    size = 2 * radius + 1
    for _ in range(3):
        image = cv2.blur(image, (size, size), borderType=cv2.BORDER_REFLECT)
    return image
