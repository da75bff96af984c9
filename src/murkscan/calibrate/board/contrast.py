"""The laser told from everything else in a photo by its colour."""

import cv2
import numpy as np

from ...types.arrays import ColourImage, Image, Vector
from .chessboard import Chessboard
from .corners import square_middles
from .view import BoardView

_BLUE_END, _GREEN_END = 490e-9, 580e-9
"""Wavelengths [m] at which a colour camera's channels take over from each other."""
_FULL = 250
"""Level from which a channel counts as saturated."""
_HOLE = 21
"""Widest saturated core of a stripe that is closed [px]."""
_NEIGHBOURHOOD = 41
"""Window in which a grey photo's paper is looked for, several stripes wide [px]."""
_BRIGHTER = 1.05
"""How much brighter than white paper a grey photo's stripe is at least: paper is grained."""
_COLOURLESS = 4
"""Difference of the channels below which a pixel is grey."""
_COLOURED = 1e-3
"""Share of coloured pixels that compression puts into a grey photo."""


def channel_of(wavelength: float) -> int:
    """Give the channel (0 red, 1 green, 2 blue) that sees a wavelength [m] best."""
    return 2 if wavelength < _BLUE_END else 1 if wavelength < _GREEN_END else 0


def laser_contrast(image: ColourImage, wavelength: float, *, white: Vector) -> Image:
    """Give how much more of the laser's colour each pixel has than white paper would have.

    The channel of the laser minus the mean of the others, after white paper has been made white:
    so paper, dark squares and white glare are 0, and the stripe stands alone. Its middle, where it
    saturates and turns white, is closed from its coloured flanks. A photo without colour gives its
    brightness above the paper instead.

    Args:
        image: The photo.
        wavelength: Wavelength of the laser [m].
        white: Red, green and blue of white paper in this photo, 0 to 255.

    Returns:
        8-bit image of the photo's size.
    """
    if is_colourless(image):
        return _brightness_above_paper(image[:, :, 1], float(white[1]))
    channel = channel_of(wavelength)
    others = [c for c in range(3) if c != channel]
    gain = white[channel] / np.maximum(white, 1.0)
    weights = np.zeros((1, 3), np.float32)
    weights[0, channel], weights[0, others] = 1.0, -gain[others] / 2
    contrast = np.clip(cv2.transform(image.astype(np.float32), weights), 0, 255)
    levels = np.round(contrast).astype(np.uint8)
    is_full = image[:, :, channel] >= _FULL
    if not is_full.any():
        return levels
    window = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (_HOLE, _HOLE))
    closed = cv2.morphologyEx(levels, cv2.MORPH_CLOSE, window)
    return np.where(is_full, closed, levels)


def is_colourless(image: ColourImage) -> bool:
    """Tell whether a photo is grey: its three channels are equal but for compression."""
    red, green, blue = cv2.split(image)
    most, least = cv2.max(cv2.max(red, green), blue), cv2.min(cv2.min(red, green), blue)
    coloured = int(np.count_nonzero(cv2.subtract(most, least) >= _COLOURLESS))
    return coloured <= _COLOURED * most.size


def white_of_board(image: ColourImage, view: BoardView, board: Chessboard) -> Vector:
    """Give the colour of the board's light squares: the median over their middles."""
    middles, alike = square_middles(view.grid(board))
    light = middles[alike != view.is_first_dark]
    u, v = np.round(light).astype(int).T
    height, width = image.shape[:2]
    inside = (u >= 0) & (u < width) & (v >= 0) & (v < height)
    return np.median(image[v[inside], u[inside]], axis=0).astype(np.float64)


def _brightness_above_paper(grey: Image, white: float) -> Image:
    """Give what is brighter than both the board's light squares and the neighbourhood.

    The first keeps out the squares' edges, the second paper in brighter light.
    """
    around = cv2.medianBlur(np.ascontiguousarray(grey), _NEIGHBOURHOOD)
    return cv2.subtract(grey, np.maximum(around, np.uint8(min(_BRIGHTER * white, 255))))
