"""Forward scattering: how water spreads a sharp picture into a peak on a broad skirt.

Each bit of light is spread by a sum of round Gaussians whose weights depend on the ways that it has
travelled. Every pixel belongs to one place of the sheet, so the weights are pictures, made once. A
Gaussian of many pixels is drawn on a picture that is smaller by as much.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import cv2
import numpy as np
from jaxtyping import Float, Float32

from ..optics.sensor import Picture
from ..types.arrays import Pixels
from ..types.laser import Axis

_FINEST = 1.5
"""Pixels that a Gaussian has at least, 1σ, on the level on which it is drawn."""
_RIM_LEVEL = 2
"""First level that reaches beyond the picture: the Gaussians below bring in nothing from there."""
_RIM = 3.5
"""How far it does so, in standard deviations of the Gaussian."""
_TABLED = 3
"""Coarsest level on which the glow beyond the picture is looked up: coarser ones are averaged."""
_LAST = 6
"""The coarsest level, of 64 pixels to one."""
_RESAMPLING = 0.25
"""Variance that shrinking pictures and growing them again adds, in pixels of the small one."""

AnyPicture = Float32[np.ndarray, "_ _"]
"""A picture of any size."""
Weights = Float[np.ndarray, "n k"]
GlowAt = Callable[[Pixels], Weights]
"""From pixels, also beyond the picture, to the light there if nothing stood in its way, times the
weight of each Gaussian."""


@dataclass(frozen=True, eq=False)
class Bell:
    """One Gaussian."""

    level: int
    """The level on which it is drawn: each is half as large as the one before."""
    sigma: float
    """1σ in pixels of that level."""
    weights: AnyPicture
    """Its weight at each pixel of the full picture, made up to whole pixels of the coarsest level,
    relative to the sharp light."""
    rim: int
    """Pixels of that level by which it reaches beyond the picture."""
    beyond: AnyPicture
    """The sheet's own glow, weighted, on that level with that rim, if nothing stood in its way;
    empty where only a stripe is spread."""


@dataclass(frozen=True, eq=False)
class WaterBlur:
    """The spreading of one laser's light, as one camera sees it."""

    size: tuple[int, int]
    """Width and height of the picture [px]."""
    axis: Axis
    """The laser's axis, across which the stripe goes on beyond the picture."""
    bells: tuple[Bell, ...]

    @classmethod
    def of(
        cls,
        size: tuple[int, int],
        axis: Axis,
        *,
        sigmas: tuple[float, ...],
        weights: Weights,
        reach: float,
        glow_at: GlowAt | None,
    ) -> "WaterBlur":
        """Tabulate the weights of Gaussians.

        Args:
            size: Width and height of the picture [px].
            axis: The laser's axis.
            sigmas: 1σ of each Gaussian [px].
            weights: Weight of each Gaussian at each pixel, row by row.
            reach: How far beyond the picture light counts [px].
            glow_at: Gives the sheet's own glow, weighted for each Gaussian; None where only a
                stripe is to be spread.
        """
        width, height = size
        weights = weights.astype(np.float32)
        bells = []
        for number, sigma in enumerate(sigmas):
            level = int(np.clip(math.floor(math.log2(sigma / _FINEST)), 0, _LAST))
            own = math.sqrt((sigma / 2**level) ** 2 - (_RESAMPLING if level else 0.0))
            rim = math.ceil(min(_RIM * own, reach / 2**level)) if level >= _RIM_LEVEL else 0
            own_weights = _fill(weights[:, number].reshape(height, width))
            bells.append(Bell(level, own, own_weights, rim, np.zeros((0, 0), np.float32)))
        if glow_at is not None:
            bells = _look_beyond(size, bells, glow_at)
        return cls(size, axis, tuple(bells))

    def spread_stripe(self, sharp: Picture) -> Picture:
        """Give the light of a stripe that reaches other pixels, to be added to the sharp picture.

        Beyond the picture it goes on along the stripe; across it there is nothing.
        """
        return self._spread(sharp, None)

    def spread_glow(self, sharp: Picture, mask: Picture) -> Picture:
        """Give the same for the sheet's glow.

        Args:
            sharp: What would be seen by light that is never scattered forward.
            mask: Share of each pixel's glow that nothing hides; beyond the picture it goes on as at
                its edge.
        """
        return self._spread(sharp, mask)

    def _spread(self, sharp: Picture, mask: Picture | None) -> Picture:
        light: list[AnyPicture | None] = [None] * (_LAST + 1)
        whole = _fill(sharp)
        free = None if mask is None else _fill(mask)
        for bell in self.bells:
            small = _shrink(whole * bell.weights, bell.level)
            if bell.rim:
                small = self._add_rim(small, bell, free)
            side = 2 * math.ceil(3.5 * bell.sigma) + 1
            drawn = cv2.GaussianBlur(
                small, (side, side), bell.sigma, borderType=cv2.BORDER_REPLICATE
            )
            drawn = drawn[bell.rim : len(drawn) - bell.rim, bell.rim : drawn.shape[1] - bell.rim]
            before = light[bell.level]
            light[bell.level] = drawn if before is None else before + drawn
        return self._grow(light)

    def _add_rim(self, picture: AnyPicture, bell: Bell, mask: AnyPicture | None) -> AnyPicture:
        rim = bell.rim
        if mask is None:
            across, along = (0, 0, rim, rim), (rim, rim, 0, 0)
            if self.axis == "x":
                across, along = along, across
            picture = cv2.copyMakeBorder(picture, *across, cv2.BORDER_REPLICATE)
            return cv2.copyMakeBorder(picture, *along, cv2.BORDER_CONSTANT, value=0)
        free = _shrink(mask, bell.level)
        whole = cv2.copyMakeBorder(free, rim, rim, rim, rim, cv2.BORDER_REPLICATE) * bell.beyond
        whole[rim:-rim, rim:-rim] = picture
        return whole

    def _grow(self, light: list[AnyPicture | None]) -> Picture:
        """Add up the levels, from the coarsest."""
        width, height = self.size
        total = np.zeros((_cells(height, _LAST), _cells(width, _LAST)), np.float32)
        for level in range(_LAST, -1, -1):
            own = light[level]
            if level < _LAST:
                rows, columns = total.shape
                total = cv2.resize(total, (2 * columns, 2 * rows), interpolation=cv2.INTER_LINEAR)
            total = total if own is None else total + own
        return total[:height, :width]


def _look_beyond(size: tuple[int, int], bells: list[Bell], glow_at: GlowAt) -> list[Bell]:
    """Give Gaussians the weighted glow beyond the picture, looked up once for those of a level."""
    found = list(bells)
    for fine in range(_RIM_LEVEL, _TABLED + 1):
        mine = [n for n, bell in enumerate(bells) if bell.rim and min(bell.level, _TABLED) == fine]
        rims = [bells[number].rim << (bells[number].level - fine) for number in mine]
        widest = max(rims, default=0)
        shape = tuple(_cells(side, fine) + 2 * widest for side in (size[1], size[0]))
        weighted = glow_at(_pixels((shape[0], shape[1]), fine, widest)) if mine else np.zeros(0)
        for number, rim in zip(mine, rims, strict=True):
            cut = slice(widest - rim, rim - widest or None)
            own = weighted[:, number].astype(np.float32).reshape(shape)[cut, cut]
            beyond = _shrink(own, bells[number].level - fine)
            found[number] = replace(bells[number], beyond=beyond)
    return found


def _fill(picture: Picture) -> AnyPicture:
    """Make a picture up to a size that can be halved down to the coarsest level."""
    down, right = (_cells(side, 0) - side for side in picture.shape)
    return cv2.copyMakeBorder(picture, 0, down, 0, right, cv2.BORDER_REPLICATE)


def _cells(side: int, level: int) -> int:
    """Give how many pixels a side has on a level, made up to whole pixels of the coarsest."""
    return math.ceil(side / 2**_LAST) * 2 ** (_LAST - level)


def _pixels(shape: tuple[int, int], level: int, rim: int) -> Pixels:
    """Give where the middles of a level's pixels lie in the full picture [px]."""
    places = [(np.arange(count) - rim + 0.5) * 2**level - 0.5 for count in shape]
    v, u = np.meshgrid(*places, indexing="ij")
    return np.stack([u.ravel(), v.ravel()], axis=1)


def _shrink(picture: AnyPicture, level: int) -> AnyPicture:
    if level == 0:
        return picture
    rows, columns = picture.shape
    size = (columns >> level, rows >> level)
    return cv2.resize(picture, size, interpolation=cv2.INTER_AREA)
