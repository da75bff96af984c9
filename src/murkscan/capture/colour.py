"""From the colours of a picture to grey levels in which the laser's light shows."""

import abc
import math
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, final

import cv2
import numpy as np
from jaxtyping import Shaped

from ..types.arrays import Image, Vector

_PEAKS = np.array([600e-9, 532e-9, 460e-9])
"""Where the red, green and blue filters of a colour camera pass most [m]."""
_WIDTHS = np.array([42e-9, 38e-9, 32e-9])
"""Standard deviations of bell curves through the filters' pass bands [m]."""
_CROSSTALK = 0.05
"""Share of any visible light that every filter passes: dyes are not perfect."""
_GREEN = (490e-9, 580e-9)
"""Wavelengths whose light lands mostly in the luma of YUV video [m]."""
_FULL = 0.98
"""Share of the scale from which a channel counts as saturated: compression rounds tops off."""
_HOLE = 21
"""Widest saturated core of a line that is closed [px], as in photographs for calibration."""
_CORNER = 2 * math.ceil((math.sqrt(2) - 1) * _HOLE / 2) + 1
"""Window that reaches from a disc of that width into the corner of a square around it [px]."""
_FRINGE = 7
"""Window that reaches over the fringe of a white area [px]: colours filled in between a mosaic's
pixels come from up to 2 px away, and the lens's own blur is another."""


class AbstractColour(abc.ABC):
    """How the colours of a picture become grey levels."""

    channels: ClassVar[int] = 1
    """Grey levels of a pixel, one beside the other."""

    @property
    @abc.abstractmethod
    def is_luma(self) -> bool:
        """Tell whether the luma of YUV video serves as well."""

    @abc.abstractmethod
    def grey(self, image: Shaped[np.ndarray, "h w *rgb"]) -> Shaped[np.ndarray, "h levels"]:
        """Give a picture's grey levels, of the same bit depth, rounded.

        Args:
            image: Red, green and blue of 8 or 16 bit, or a picture without colours.
        """


@final
@dataclass(frozen=True)
class EachColour(AbstractColour):
    """Red, green and blue as they are, side by side: to look at the colours themselves."""

    channels: ClassVar[int] = 3

    @property
    def is_luma(self) -> bool:
        """Tell whether the luma of YUV video serves as well: it has no colours."""
        return False

    def grey(self, image: Shaped[np.ndarray, "h w *rgb"]) -> Shaped[np.ndarray, "h levels"]:
        """Give three grey levels a pixel; see the base. Without colours they are the same."""
        colours = np.dstack([image] * 3) if image.ndim == 2 else image
        return np.ascontiguousarray(colours).reshape(len(image), -1)


@final
@dataclass(frozen=True)
class LaserColour(AbstractColour):
    """How much each colour of a pixel counts for the laser's light.

    Two kinds are in use. A mean, with weights above 0, is best in the dark: it collects all of the
    laser's light. A contrast, with weights below 0 for colours that the laser has not, is best
    where daylight or a lamp shows as well: what their light explains is taken off.
    """

    wavelength: float
    """Of the laser in air [m]."""
    weights: tuple[float, float, float]
    """Of red, green and blue."""
    pedestal: float = 0.0
    """What is added, as a share of the scale, so that noise about 0 keeps both its sides."""

    @staticmethod
    def mean(wavelength: float) -> "LaserColour":
        """Weigh colours for the dark; grey stays grey.

        Each weight is the square root of the filter's response: half way from the response itself,
        best against noise, to equal weights, best where the laser's own channel is saturated and
        only the others still tell where the middle of the line is.
        """
        weights = np.sqrt(filter_response(wavelength))
        red, green, blue = (weights / weights.sum()).tolist()
        return LaserColour(wavelength, (red, green, blue))

    @property
    def is_contrast(self) -> bool:
        """Tell whether light of other colours is taken off."""
        return min(self.weights) < 0

    @cached_property  # asked of each picture of a video
    def is_luma(self) -> bool:
        """Tell whether the luma of YUV video serves as well: it holds most of a green laser."""
        is_green = _GREEN[0] <= self.wavelength <= _GREEN[1]
        return is_green and self == LaserColour.mean(self.wavelength)

    def grey(self, image: Shaped[np.ndarray, "h w *rgb"]) -> Image:
        """Give a picture's grey levels; see the base. Without colours it stays as it is."""
        if image.ndim == 2:
            return image
        top = np.iinfo(image.dtype).max
        levels = image.astype(np.float32) @ np.array(self.weights, np.float32)
        if self.is_contrast:
            levels = self._mend_saturated(image, levels + np.float32(self.pedestal * top))
        return np.clip(np.rint(levels), 0, top).astype(image.dtype)

    def _mend_saturated(
        self, image: Shaped[np.ndarray, "h w 3"], levels: Shaped[np.ndarray, "h w"]
    ) -> Shaped[np.ndarray, "h w"]:
        """Give what is saturated, so that its colour is lost, the level of what is around it."""
        top = np.iinfo(image.dtype).max
        is_full = image >= _FULL * top
        own = is_full[..., int(np.argmax(self.weights))]
        taken_off = np.all(is_full[..., np.less(self.weights, 0)], axis=-1)
        if taken_off.any():
            levels = _without_fringes(levels, taken_off)
        if not own.any():
            return levels
        levels = np.where(is_full.all(axis=-1), np.float32(self.pedestal * top), levels)
        return np.where(own, cv2.morphologyEx(levels, cv2.MORPH_CLOSE, _disc(_HOLE)), levels)


def _without_fringes(
    levels: Shaped[np.ndarray, "h w"], is_white: Shaped[np.ndarray, "h w"]
) -> Shaped[np.ndarray, "h w"]:
    """Give the rims of white areas the lowest level around: lens and sensor part the colours there.

    An area is wider than a line's saturated core, up to its corners.
    """
    white = is_white.astype(np.uint8)
    area = cv2.morphologyEx(white, cv2.MORPH_OPEN, _disc(_HOLE))
    if not area.any():
        return levels
    area = cv2.dilate(area, _disc(_CORNER)) & white
    fringe = _disc(_FRINGE)
    return np.where(cv2.dilate(area, fringe) > 0, cv2.erode(levels, fringe), levels)


def _disc(size: int) -> Shaped[np.ndarray, "size size"]:
    return cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (size, size))


def filter_response(wavelength: float) -> Vector:
    """Give the share of a laser's light that a colour camera's red, green and blue filters pass.

    Args:
        wavelength: Of the laser in air [m]. Beyond the visible a filter no longer matters: the
            nearest visible colour stands for it.

    References:
        Jiang, Liu, Gu, Süsstrunk, What is the space of spectral sensitivity functions for
        digital color cameras?, WACV 2013 (28 cameras measured; the bell curves approximate them).
    """
    visible = min(max(wavelength, 430e-9), 660e-9)
    bells = np.exp(-0.5 * ((visible - _PEAKS) / _WIDTHS) ** 2)
    return _CROSSTALK + (1 - _CROSSTALK) * bells
