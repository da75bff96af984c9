"""What stands in the camera's window: dirt, scratches, and a light that its glass mirrors."""

import math
from dataclasses import dataclass

import cv2
import numpy as np

from ..errors import InputError
from ..optics.sensor import Picture
from ..types.laser import Axis
from .sensor import blur_lens

_SPOT = 4.0
"""Median radius of a spot of dirt [px]; a third of them are smaller or larger by half as much."""
_DENSE = 0.3, 0.9
"""Share of light that a spot takes, from the thinnest to the thickest."""
_CUT = 0.5, 0.8
"""The same of a scratch, which throws it aside."""
_ASIDE = 0.05
"""How far dirt throws light aside [rad], 1σ: grains of 10 µm diffract green light by λ/d."""
_FINE = 4.0
"""Blur on the smaller picture [its px], 1σ: its pixels widen it by less than one per cent."""
_KEPT = 0.8
"""Share of what dirt takes that it throws aside; the rest it absorbs."""
_SLOPE = 0.03
"""Slope of the mirrored line against the picture's edge, at most."""
_LINE = 1.5
"""Width of the mirrored line [px], 1σ."""
_MOST_SCRATCHES = 1000


@dataclass(frozen=True)
class Window:
    """The flaws of a window; they stand still in the picture, whatever passes behind."""

    dirt: float = 0.0
    """Share of the picture that spots of dirt cover."""
    scratches: int = 0
    """Scratches across the picture."""
    ghost: float = 0.0
    """Height of a line of light that the glass mirrors [grey levels]; the laser's own or another,
    it stays when the laser is off."""
    blur: float = 1.0
    """How much dirt and scratches are out of focus [px], 1σ."""

    def __post_init__(self) -> None:
        """Refuse a window that cannot be."""
        if not 0 <= self.dirt <= 0.5:
            raise InputError(
                f"window.dirt_percent must lie between 0 and 50, got {100 * self.dirt:g}."
            )
        if not 0 <= self.scratches <= _MOST_SCRATCHES:
            raise InputError(
                f"window.scratches must lie between 0 and {_MOST_SCRATCHES}, got {self.scratches}."
            )
        if not (0 <= self.ghost <= 65535 and 0 <= self.blur <= 100):
            raise InputError(
                "window.ghost_grey must lie between 0 and 65535, and window.blur_px between 0 and "
                f"100, got {self.ghost:g} and {self.blur:g}."
            )


@dataclass(frozen=True, eq=False)
class WindowView:
    """A window as one camera sees it."""

    transmission: Picture
    """Share of light that each pixel's way through the window lets pass."""
    ghost: Picture
    """Light that the glass mirrors [grey levels]."""
    aside: float
    """How far light is thrown aside by dirt [px], 1σ; 0 for a clean window."""

    def pass_light(self, light: Picture) -> Picture:
        """Give what is left of light behind the window, with what dirt throws aside."""
        if self.aside == 0:
            return light
        around = _blur_broadly(light, self.aside)
        return light * self.transmission + np.float32(_KEPT) * (1 - self.transmission) * around


def _blur_broadly(light: Picture, sigma: float) -> Picture:
    """Blur by many pixels on a smaller picture: what is so broad has no details to lose."""
    height, width = light.shape
    times = max(int(sigma / _FINE), 1)
    size = -(-width // times), -(-height // times)
    small = cv2.resize(light, size, interpolation=cv2.INTER_AREA)
    own = sigma * size[0] / width
    return cv2.resize(blur_lens(small, own, own), (width, height), interpolation=cv2.INTER_LINEAR)


def view_window(
    window: Window, size: tuple[int, int], *, focal_length: float, axis: Axis, seed: int
) -> WindowView:
    """Draw a window's flaws.

    Args:
        window: How many there are.
        size: Width and height of the picture [px].
        focal_length: Of the camera [px].
        axis: The laser's axis, across which the mirrored line runs.
        seed: Where they lie.
    """
    width, height = size
    opacity = np.zeros((height, width), np.uint8)
    random = np.random.default_rng([seed, 3, 0])
    _draw_dirt(opacity, window.dirt, random)
    for _ in range(window.scratches):
        _draw_scratch(opacity, random)
    taken = blur_lens(opacity.astype(np.float32) / 255, window.blur, window.blur)
    ghost = np.zeros_like(taken)
    if window.ghost > 0:
        _draw_ghost(ghost if axis == "y" else ghost.T, window.ghost, seed)
    return WindowView(1 - taken, ghost, _ASIDE * focal_length if opacity.any() else 0.0)


def _draw_dirt(opacity: np.ndarray, share: float, random: np.random.Generator) -> None:
    """Draw spots until they cover that share of the picture."""
    height, width = opacity.shape
    while np.count_nonzero(opacity) < share * opacity.size:
        middle = random.integers(0, (width, height)).tolist()
        radius = _SPOT * math.exp(0.5 * random.standard_normal())
        axes = np.rint(radius * random.uniform(0.6, 1.6, 2)).astype(int)
        dense = 255 * random.uniform(*_DENSE)
        cv2.ellipse(opacity, middle, np.maximum(axes, 1).tolist(), random.uniform(0, 180), 0, 360,
                    dense, -1, cv2.LINE_AA)  # fmt: skip


def _draw_scratch(opacity: np.ndarray, random: np.random.Generator) -> None:
    """Draw a slightly bent line through the inner half of the picture."""
    height, width = opacity.shape
    middle = random.uniform(0.25, 0.75, 2) * (width, height)
    angle, bend = random.uniform(0, math.pi), random.normal(0, 0.15)
    length = random.uniform(0.3, 0.9) * width
    along = np.linspace(-0.5, 0.5, 30)[:, None] * length
    way = np.array([math.cos(angle), math.sin(angle)])
    points = middle + along * way + bend / length * along**2 * way[::-1] * (-1, 1)
    deep, thick = 255 * random.uniform(*_CUT), int(random.integers(1, 3))
    sixteenths = np.rint(16 * points).astype(int)
    cv2.polylines(opacity, [sixteenths], False, deep, thick, cv2.LINE_AA, shift=4)


def _draw_ghost(picture: Picture, height: float, seed: int) -> None:
    """Draw a straight line along the rows."""
    random = np.random.default_rng([seed, 3, 1])
    rows, columns = picture.shape
    at = random.uniform(0.25, 0.75) * rows
    at = at + random.uniform(-_SLOPE, _SLOPE) * (np.arange(columns) - columns / 2)
    away = np.arange(rows)[:, None] - at
    picture += np.float32(height) * np.exp(-0.5 * (away / _LINE) ** 2).astype(np.float32)
