"""Pictures of what was found in each photo, with what is left over."""

from itertools import pairwise

import cv2
import numpy as np
from jaxtyping import Float, UInt8

from ...types.arrays import ColourImage, Pixels, Scalars
from .chessboard import Chessboard
from .view import BoardView

Canvas = UInt8[np.ndarray, "height width 3"]
"""A photo enlarged and written on: red, green, blue."""
_GAIN = 40
"""How much longer than they are residuals are drawn."""
_MIN_WIDTH = 1200
"""Width to which a small photo is enlarged, so that lines stay thin on it [px]."""
_SHEET_TOLERANCE = 2e-3
"""Distance from its sheet at which a stripe point is drawn red, not blue [m]."""
_GREEN, _RED, _YELLOW, _BLUE = (0, 220, 70), (255, 50, 40), (255, 210, 0), (40, 140, 255)


def draw_photo(
    photo: ColourImage,
    view: BoardView,
    board: Chessboard,
    note: str,
    *,
    residuals: Float[np.ndarray, "_ 2"],
    stripe: Float[np.ndarray, "_ 2"],
    distances: Scalars,
) -> Canvas:
    """Draw what was found in one photo, and a line of words.

    Args:
        photo: The photo.
        view: Its corners; of length 0 where the board was not found.
        board: The board.
        note: What to write on top.
        residuals: Corner as found minus corner as projected [px], or of length 0 for none.
        stripe: Stripe points [px]; of length 0 for none.
        distances: Distance of each from its laser's sheet [m], or of length 0 for none.
    """
    canvas, zoom = _enlarge(photo)
    if view.is_found:
        for row in view.grid(board):
            _line(canvas, row[np.isfinite(row[:, 0])], zoom, _YELLOW)
        for corner in view.corners:
            cv2.circle(canvas, _at(corner, zoom), 4, _GREEN, 1, cv2.LINE_AA)
        cv2.circle(canvas, _at(view.corners[0], zoom), 9, _BLUE, 2, cv2.LINE_AA)
    for corner, residual in zip(view.corners, residuals, strict=False):
        _line(canvas, np.stack([corner, corner + _GAIN * residual]), zoom, _RED, thickness=2)
    if len(residuals):
        note += f"   (red lines: residuals x {_GAIN}; blue ring: first corner)"
    distances = distances if len(distances) else np.zeros(len(stripe))
    shares = np.clip(np.abs(distances) / _SHEET_TOLERANCE, 0, 1)
    for pixel, share in zip(stripe, shares, strict=True):
        colour = tuple(int((1 - share) * g + share * r) for g, r in zip(_BLUE, _RED, strict=True))
        cv2.circle(canvas, _at(pixel, zoom), 1, colour, -1, cv2.LINE_AA)
    return _write(canvas, note)


def _enlarge(photo: ColourImage) -> tuple[Canvas, float]:
    zoom = float(max(1, round(_MIN_WIDTH / photo.shape[1])))
    if zoom == 1:
        return photo.copy(), zoom
    return cv2.resize(photo, None, fx=zoom, fy=zoom, interpolation=cv2.INTER_CUBIC), zoom


def _at(pixel: Scalars, zoom: float) -> tuple[int, int]:
    """Give where a pixel lies on the enlarged photo; pixel 0 is the middle of its first ones."""
    u, v = np.clip(np.round((pixel + 0.5) * zoom - 0.5), -30000, 30000)
    return int(u), int(v)


def _line(
    canvas: Canvas,
    pixels: Pixels,
    zoom: float,
    colour: tuple[int, int, int],
    thickness: int = 1,
) -> None:
    for start, end in pairwise(pixels):
        cv2.line(canvas, _at(start, zoom), _at(end, zoom), colour, thickness, cv2.LINE_AA)


def _write(canvas: Canvas, note: str) -> UInt8[np.ndarray, "higher width 3"]:
    height = max(22, canvas.shape[1] // 45)
    size = height / 36
    strip = np.full((height, canvas.shape[1], 3), 24, np.uint8)
    cv2.putText(
        strip, note, (8, int(height * 0.7)), cv2.FONT_HERSHEY_SIMPLEX, size, (240, 240, 240), 1,
        cv2.LINE_AA,
    )  # fmt: skip
    return np.concatenate([strip, canvas])
