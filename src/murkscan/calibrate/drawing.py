"""Pictures of what was found in each photo, with what is left over."""

from itertools import pairwise

import cv2
import numpy as np
from jaxtyping import Float, UInt8

from ..optics import project
from ..types.arrays import ColourImage, Pixels, Scalars
from ..types.camera import Camera
from ..types.pose import Pose
from .board import Chessboard, Margin
from .view import BoardView

Canvas = UInt8[np.ndarray, "height width 3"]
"""A photo enlarged and written on: red, green, blue."""
_GAIN = 40
"""How much longer than they are residuals are drawn."""
_MIN_WIDTH = 1200
"""Width to which a small photo is enlarged, so that lines stay thin on it [px]."""
_GREEN, _RED, _YELLOW, _BLUE = (0, 220, 70), (255, 50, 40), (255, 210, 0), (40, 140, 255)


def draw_board(
    photo: ColourImage, view: BoardView, board: Chessboard, residuals: Pixels, note: str
) -> Canvas:
    """Draw the corners of one photo, each with its residual, and a line of words.

    Args:
        photo: The photo.
        view: Its corners; of length 0 where the board was not found.
        board: The board.
        residuals: Corner as found minus corner as projected [px], or of length 0 for none.
        note: What to write on top.
    """
    canvas, zoom = _enlarge(photo)
    if view.is_found:
        for row in _rows_of(view, board):
            _line(canvas, row, zoom, _YELLOW)
        for corner in view.corners:
            cv2.circle(canvas, _at(corner, zoom), 4, _GREEN, 1, cv2.LINE_AA)
        cv2.circle(canvas, _at(view.corners[0], zoom), 9, _BLUE, 2, cv2.LINE_AA)
        for corner, residual in zip(view.corners, residuals, strict=False):
            ends = np.stack([corner, corner + _GAIN * residual])
            _line(canvas, ends, zoom, _RED, thickness=2)
        note += f"   (red: residuals x {_GAIN}; blue: first corner)"
    return _write(canvas, note)


def _rows_of(view: BoardView, board: Chessboard) -> list[Pixels]:
    """Give the corners row by row."""
    numbers = np.arange(board.num_corners) if view.numbers is None else view.numbers
    return [view.corners[numbers // board.columns == row] for row in range(board.rows)]


def draw_stripe_on_board(
    photo: ColourImage,
    pixels: Pixels,
    residuals: Scalars,
    note: str,
    *,
    outline: Float[np.ndarray, "k 2"],
    tolerance: float,
) -> Canvas:
    """Draw the stripe points of one photo, coloured by residual, and the sheet's outline.

    Args:
        photo: The photo.
        pixels: The stripe points used [px]; may be none.
        residuals: Distance of each from the laser's sheet [m].
        note: What to write on top.
        outline: Where the board's paper ends in the photo [px]; may be none.
        tolerance: Distance from the sheet at which a point is red [m].
    """
    canvas, zoom = _enlarge(photo)
    if len(outline):
        _line(canvas, np.concatenate([outline, outline[:1]]), zoom, _YELLOW)
    shares = np.clip(np.abs(residuals) / tolerance, 0, 1)
    for pixel, share in zip(pixels, shares, strict=True):
        colour = tuple(int((1 - share) * g + share * r) for g, r in zip(_BLUE, _RED, strict=True))
        cv2.circle(canvas, _at(pixel, zoom), 1, colour, -1, cv2.LINE_AA)
    if len(pixels):
        note += f"   (blue: on the sheet; red: {tolerance * 1e3:.1f} mm or more off)"
    return _write(canvas, note)


def project_outline(
    board: Chessboard,
    margin: Margin,
    camera: Camera,
    camera_from_board: Pose,
    index: float | None = None,
) -> Pixels:
    """Give where the board's paper ends in the photo [px]; none if it runs behind the camera."""
    corners = project(camera, camera_from_board @ board.outline(margin), index)
    return corners if np.isfinite(corners).all() else np.zeros((0, 2))


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
