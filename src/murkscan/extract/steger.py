"""The ridge of the smoothed picture: follows a line in any direction, and through dim places."""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import final

import numpy as np

from .._kernels.steger import find_ridges
from ..errors import InputError
from ..types.arrays import Image
from ..types.background import Background
from ..types.frame import Frame
from ..types.rig import Rig
from ..types.stripe import Stripe
from .base import AbstractExtractor
from .candidates import Candidates

_TAYLOR = 0.006
"""Error of the second-order expansion for a Gaussian ridge within its pixel [px]."""


@final
@dataclass(frozen=True)
class Steger(AbstractExtractor):
    """Where the first derivative across the ridge vanishes, in a picture smoothed by a Gaussian.

    The point given is where the ridge crosses the middle of the scan line.

    References:
        Steger, An unbiased detector of curvilinear structures, IEEE PAMI 20(2), 1998.
    """

    width: float = 2.0
    """Standard deviation of the smoothing [px]: at least that of the stripe, over the root of 3."""
    min_height: float = 10.0
    """Grey levels, of 8 bits, by which a peak must rise above both of its sides."""
    min_contrast: float = 5.0
    """The same, in standard deviations of the noise."""

    def __post_init__(self) -> None:
        """Refuse settings that find nothing, or everything."""
        if not 0.5 <= self.width <= 20:
            raise InputError(f"Steger's width must be 0.5 to 20 px, got {self.width:g}.")
        self._candidates()

    def extract(
        self, frames: Iterable[Frame], rig: Rig, background: Background, *, laser: int = 0
    ) -> Iterator[Stripe]:
        """Find the stripe in each frame; see `AbstractExtractor.extract`."""
        derivatives = _gaussian_derivatives(self.width)

        def measure(image: Image, peaks: np.ndarray, down: bool) -> np.ndarray:
            found = find_ridges(image, peaks, down, derivatives, background.noise)
            found[:, 1] = np.hypot(found[:, 1], _TAYLOR)
            return found

        return self._candidates().extract(frames, rig, background, laser, measure)

    def _candidates(self) -> Candidates:
        return Candidates(4 * self.width, self.min_height, self.min_contrast)


def _gaussian_derivatives(width: float) -> np.ndarray:
    """Windows that give the derivatives x, y, xx, xy, yy of a smoothed picture (5 h h).

    Sampled and cut off, a Gaussian's derivatives are no longer exact: they are scaled so that those
    of a line and of a parabola are.
    """
    radius = math.ceil(4 * width)
    x = np.arange(-radius, radius + 1.0)
    zeroth = np.exp(-0.5 * (x / width) ** 2)
    zeroth /= zeroth.sum()
    first = x * zeroth
    first /= first @ x
    second = (x**2 / width**2 - 1) * zeroth
    second -= second.mean()
    second *= 2 / (second @ x**2)
    pairs = ((first, zeroth), (zeroth, first), (second, zeroth), (first, first), (zeroth, second))
    return np.stack([np.outer(down, along) for along, down in pairs])
