"""A Gaussian fitted to the peak: near the limit that noise sets, and slower."""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import final

import numpy as np

from .._kernels.gaussian_fit import fit_peaks
from ..types.arrays import Image
from ..types.background import Background
from ..types.frame import Frame
from ..types.rig import Rig
from ..types.stripe import Stripe
from .base import AbstractExtractor
from .candidates import Candidates


@final
@dataclass(frozen=True)
class GaussianFit(AbstractExtractor):
    """A Gaussian on a sloping background, fitted to each peak by least squares.

    Pixels at the frame's highest level, which may be saturated, are left out. The standard
    deviation of the centre is that of the fit.

    References:
        Marquardt, An algorithm for least-squares estimation of nonlinear parameters, SIAM 11(2),
        1963.
    """

    half_width: float = 10.0
    """Half the window [px]: about four times the stripe's own standard deviation."""
    min_height: float = 10.0
    """Grey levels, of 8 bits, by which a peak must rise above both of its sides."""
    min_contrast: float = 5.0
    """The same, in standard deviations of the noise."""

    def __post_init__(self) -> None:
        """Refuse settings that find nothing, or everything."""
        self._candidates()

    def extract(
        self, frames: Iterable[Frame], rig: Rig, background: Background, *, laser: int = 0
    ) -> Iterator[Stripe]:
        """Find the stripe in each frame; see `AbstractExtractor.extract`."""

        def measure(image: Image, peaks: np.ndarray, down: bool) -> np.ndarray:
            # A sensor may saturate below the largest number of its file: 12 bit in 16, say. Where
            # it did not, little is lost: the very top of a peak says least about its centre.
            full = float(image.max())
            half_width = math.ceil(self.half_width)
            return fit_peaks(image, peaks, down, half_width, background.noise, full)

        return self._candidates().extract(frames, rig, background, laser, measure)

    def _candidates(self) -> Candidates:
        return Candidates(self.half_width, self.min_height, self.min_contrast)
