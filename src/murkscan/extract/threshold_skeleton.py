"""The paper's way: a threshold, and the skeleton of what exceeds it."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import final

import cv2
import numpy as np

from .._kernels.thinning import thin_zhang_suen
from ..errors import InputError
from ..types.arrays import BinaryImage, Image
from ..types.background import Background
from ..types.frame import Frame
from ..types.rig import Rig
from ..types.stripe import Stripe
from .assemble import assemble_stripe
from .base import AbstractExtractor

OTSU = 0.0
"""The level that stands for Otsu's automatic one."""
_SIGMA = np.sqrt(1 / 12 + 1 / 12)
"""Standard deviation of a centre that may lie anywhere in its pixel, of a stripe of which thinning
may have taken one pixel more on either side [px]."""


@final
@dataclass(frozen=True)
class ThresholdSkeleton(AbstractExtractor):
    """Zhang-Suen skeleton of the pixels above a level: one whole pixel a branch and scan line.

    References:
        The paper's sections "Thresholding" and "Skeletonization algorithm"; Zhang and Suen, A fast
        parallel algorithm for thinning digital patterns, CACM 27(3), 1984; Otsu, A threshold
        selection method from gray-level histograms, IEEE SMC 9(1), 1979.
    """

    level: float = OTSU
    """Grey level above which a pixel is stripe; 0 takes Otsu's, for each frame."""
    min_height: float = 10.0
    """Grey levels, of 8 bits, by which the stripe must exceed the rest, on average, under Otsu's
    level."""
    min_contrast: float = 8.0
    """The same, in standard deviations of the noise."""

    def __post_init__(self) -> None:
        """Refuse levels that no picture has."""
        if not (self.level >= 0 and self.min_height >= 1 and self.min_contrast >= 0):
            raise InputError(
                f"ThresholdSkeleton needs level ≥ 0, min_height ≥ 1 and min_contrast ≥ 0, got "
                f"{self.level:g}, {self.min_height:g} and {self.min_contrast:g}."
            )

    def extract(
        self, frames: Iterable[Frame], rig: Rig, background: Background, *, laser: int = 0
    ) -> Iterator[Stripe]:
        """Find the stripe in each frame; see `AbstractExtractor.extract`."""
        axis = rig.lasers[laser].axis
        for frame in frames:
            skeleton = thin_zhang_suen(self._binarise(frame.image, background))
            levels, rest = frame.image, float(np.median(frame.image))
            lines, centres = _find_runs(skeleton.T if axis == "y" else skeleton)
            where = (centres, lines) if axis == "y" else (lines, centres)
            yield assemble_stripe(
                frame,
                axis,
                laser,
                lines=lines,
                centres=centres.astype(float),
                sigma=np.full(len(lines), _SIGMA),
                signal=levels[where].astype(float) - rest,
            )

    def _binarise(self, image: Image, background: Background) -> BinaryImage:
        if self.level != OTSU:
            return image > self.level
        level, _ = cv2.threshold(image, 0, 0, cv2.THRESH_BINARY | cv2.THRESH_OTSU)
        above = image > level
        # Otsu's level parts any picture in two, noise as well: a stripe must be brighter than that.
        least = max(self.min_height * background.scale, self.min_contrast * background.noise)
        if above.all() or not above.any() or image[above].mean() - image[~above].mean() < least:
            return np.zeros(image.shape, bool)
        return above


def _find_runs(skeleton: BinaryImage) -> tuple[np.ndarray, np.ndarray]:
    """Give row and middle column of each run of pixels: where a skeleton runs along the scan line,
    its pixels are one centre, not branches."""  # noqa: D205, D209
    lines, positions = np.nonzero(skeleton)
    begins = np.flatnonzero(
        (np.diff(lines, prepend=-1) != 0) | (np.diff(positions, prepend=-9) > 1)
    )
    ends = np.append(begins[1:], len(lines)) - 1
    if len(lines) == 0:
        return lines, positions
    return lines[begins], (positions[begins] + positions[ends]) // 2
