"""Where a stripe may be: peaks that stand out of the noise; each extractor then measures them."""

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from .._kernels.peaks import find_peaks
from ..errors import InputError
from ..types.arrays import Image
from ..types.background import Background
from ..types.frame import Frame
from ..types.rig import Rig
from ..types.stripe import Stripe
from .assemble import assemble_stripe

_MOST = 16
"""Peaks a scan line, on average, up to which a frame is looked at: more of them are no stripe."""
_CLEAR = 5
"""Pixels beyond the foot of a stripe that show what surrounds it."""

Measure = Callable[[Image, np.ndarray, bool], np.ndarray]
"""From an image, peaks (n 2: scan line, position) and whether scan lines are columns, to centre,
sigma and signal (n 3); NaN where there is no stripe at a peak."""


@dataclass(frozen=True)
class Candidates:
    """How much a peak must stand out."""

    half_width: float
    """Half the width of a stripe, at its foot [px]."""
    min_height: float
    """Grey levels, of 8 bits, by which a peak must rise above both of its sides."""
    min_contrast: float
    """The same, in standard deviations of the noise."""

    def __post_init__(self) -> None:
        """Refuse settings with which no peak, or every pixel, would be found."""
        if not (1 <= self.half_width <= 1000 and self.min_height >= 1 and self.min_contrast >= 0):
            raise InputError(
                f"A stripe needs half_width from 1 to 1000 px, min_height ≥ 1 grey level and "
                f"min_contrast ≥ 0, got {self.half_width:g}, {self.min_height:g} and "
                f"{self.min_contrast:g}."
            )

    def rise(self, background: Background) -> float:
        """Give the height that a stripe must have [grey levels]."""
        return max(self.min_height * background.scale, self.min_contrast * background.noise)

    def extract(
        self,
        frames: Iterable[Frame],
        rig: Rig,
        background: Background,
        laser: int,
        measure: Measure,
    ) -> Iterator[Stripe]:
        """Find the peaks of each frame, measure them, and assemble its stripe."""
        axis = rig.lasers[laser].axis
        rise = math.ceil(self.rise(background))
        near = math.ceil(self.half_width)
        for frame in frames:
            image, down = np.ascontiguousarray(frame.image), axis == "y"
            num_lines = image.shape[1 if down else 0]
            peaks = find_peaks(image, down, rise, near + _CLEAR, near, _MOST * num_lines)
            centres, sigma, signal = measure(image, peaks, down).T
            yield assemble_stripe(
                frame,
                axis,
                laser,
                lines=peaks[:, 0],
                centres=np.where(signal >= self.rise(background), centres, np.nan),
                sigma=sigma,
                signal=signal,
                shadow=2.0 * (near + _CLEAR),
            )
