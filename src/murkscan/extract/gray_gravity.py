"""Centre of mass around the peak: fast, and insensitive to the stripe's shape and width."""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import final

import numpy as np

from .._kernels.gray_gravity import weigh_peaks
from ..errors import InputError
from ..types.arrays import Image
from ..types.background import Background
from ..types.frame import Frame
from ..types.rig import Rig
from ..types.stripe import Stripe
from .base import AbstractExtractor
from .candidates import Candidates


@final
@dataclass(frozen=True)
class GrayGravity(AbstractExtractor):
    """Centre of mass of the grey levels around each peak, background taken off.

    They are weighed in a window without edges, whose reach follows from the stripe's width at its
    foot. It lies on the centre that it gives, and is blind to light with an even slope, such as
    glow and what the water scatters forward.

    References:
        Naidu and Fisher, A comparative analysis of algorithms for determining the peak position of
        a stripe to sub-pixel accuracy, BMVC 1991.
    """

    half_width: float = 12.0
    """Width of the widest stripe at its foot [px]; beyond it on both sides lies background."""
    foot: float = 0.25
    """Share of the peak's height at which the stripe's width is taken."""
    min_height: float = 10.0
    """Grey levels, of 8 bits, by which a peak must rise above both of its sides."""
    min_contrast: float = 5.0
    """The same, in standard deviations of the noise."""

    def __post_init__(self) -> None:
        """Refuse settings that find nothing, or everything."""
        if not 0 <= self.foot < 1:
            raise InputError(f"The foot must be from 0 up to 1, got {self.foot:g}.")
        self._candidates()

    def extract(
        self, frames: Iterable[Frame], rig: Rig, background: Background, *, laser: int = 0
    ) -> Iterator[Stripe]:
        """Find the stripe in each frame; see `AbstractExtractor.extract`."""
        half_width, least = math.ceil(self.half_width), self._candidates().rise(background)

        def measure(image: Image, peaks: np.ndarray, down: bool) -> np.ndarray:
            return weigh_peaks(image, peaks, down, half_width, self.foot, least, background.noise)

        return self._candidates().extract(frames, rig, background, laser, measure)

    def _candidates(self) -> Candidates:
        return Candidates(self.half_width, self.min_height, self.min_contrast)
