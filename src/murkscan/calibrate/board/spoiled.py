"""What spoils a photo of a board, in words: glare, blur, the picture's edge."""

import cv2
import numpy as np
from jaxtyping import Shaped

from ...types.arrays import Image, Pixels
from .chessboard import Chessboard
from .view import BoardView

_WHITE = 250
"""Level from which a pixel is overexposed."""
_BLOB = 9
"""Width below which white is a thin thing, such as a stripe, and no glare [px of 640]."""
_GLARE = 0.005
"""Share of the picture that one overexposed blob covers from which it is glare."""
_SIZE = 640
"""Width at which pictures are judged [px]."""
_SHARP = 0.12
"""Steepest edges of a sharp picture, over its contrast [1/px]: a blur of σ px has 1/(σ √(2π))."""
_NOISE = 1.0
"""Smoothing before slopes are taken [px]."""
_CONTRAST = 20.0
"""Grey levels between dark and light below which there is nothing to be sharp."""


def name_spoiler(photo: Image, view: BoardView, board: Chessboard) -> str:
    """Say what spoils a photo; empty where nothing does that is known of.

    Args:
        photo: The photo, grey, 8 bit.
        view: What was found of the board.
        board: The board.
    """
    hidden = board.num_corners - len(view.corners)
    if hidden and has_glare(photo):
        seen = f"hides {hidden} corners of the board" if view.is_found else "hides the board"
        return f"glare {seen}: turn the board or move the lamp until no part of it is white"
    if view.is_found:
        return "" if view.is_placed else (
            f"the picture's edge cuts off {hidden} corners of the board: show all of it once"
        )  # fmt: skip
    if is_blurred(photo):
        return "it is blurred: mend the focus, or hold the board still"
    return ""


def is_cut_off(corners: Pixels, pitch: float, shape: tuple[int, ...]) -> bool:
    """Tell whether corners that were found go on to the picture's edge.

    Args:
        corners: What was found of the board [px].
        pitch: Distance of neighbouring corners [px].
        shape: Height and width of the photo.
    """
    room = np.minimum(corners, np.array([shape[1] - 1, shape[0] - 1]) - corners)
    return bool(room.min() < 1.5 * pitch)


def has_glare(photo: Image) -> bool:
    """Tell whether one blob of the photo is overexposed, as no paper of a good photo is."""
    small = _shrink(photo)
    white = np.asarray(small >= _WHITE, np.uint8)
    opened = cv2.morphologyEx(white, cv2.MORPH_OPEN, np.ones((_BLOB, _BLOB), np.uint8))
    areas = cv2.connectedComponentsWithStats(opened)[2][1:, cv2.CC_STAT_AREA]
    return bool(areas.max(initial=0) > _GLARE * small.size)


def is_blurred(photo: Image) -> bool:
    """Tell whether even the steepest edges of the photo are wide."""
    smooth = cv2.GaussianBlur(_shrink(photo).astype(np.float32), (0, 0), _NOISE)
    dark, light = np.percentile(smooth, [1, 99])
    if light - dark < _CONTRAST:
        return False
    slopes = np.hypot(*np.gradient(smooth))
    return bool(np.percentile(slopes, 99.5) < _SHARP * (light - dark))


def _shrink(photo: Image) -> Shaped[np.ndarray, "rows columns"]:
    scale = min(_SIZE / photo.shape[1], 1.0)
    if scale == 1.0:
        return photo
    size = (_SIZE, max(round(photo.shape[0] * scale), 1))
    return cv2.resize(photo, size, interpolation=cv2.INTER_AREA)
