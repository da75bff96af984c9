"""A filter for ridges of one width, blind to what slopes or bends beneath them."""

import math
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float32

from .._kernels.matched_filter import score_pixels
from ..types.arrays import Ratios
from ..types.background import Noise
from .scan_lines import ScanLines


@dataclass(frozen=True, eq=False)
class MatchedFilter:
    """The filter, and the noise by which its answer is divided."""

    noise: Noise
    """Of a pixel."""
    template: Ratios

    @classmethod
    def of(cls, width: float, noise: Noise) -> "MatchedFilter":
        """Make the filter of a width: a Gaussian without its part in 1, x and x², of norm 1."""
        half = max(5, math.ceil(4 * width) + 2)
        x = np.arange(-half, half + 1.0)
        bell = np.exp(-0.5 * (x / width) ** 2)
        smooth = np.stack([x**0, x, x**2], axis=1)
        bell -= smooth @ np.linalg.lstsq(smooth, bell, rcond=None)[0]
        return cls(noise, (bell / np.linalg.norm(bell)).astype(np.float32))

    @property
    def reach(self) -> int:
        """Pixels from a ridge up to which it has side lobes."""
        return len(self.template) // 2 + 4

    def score(self, lines: ScanLines) -> "Scored":
        """Score each pixel of a frame."""
        noise = self.noise
        scores = score_pixels(lines.levels, self.template, noise.fixed, noise.gain, noise.least)
        return Scored(lines, scores)


@dataclass(frozen=True, eq=False)
class Scored:
    """How much each pixel of a frame looks like the middle of a stripe."""

    lines: ScanLines
    scores: Float32[np.ndarray, "length lines"]
    """In standard deviations of the noise."""

    @property
    def index(self) -> int:
        """Number of the frame in its recording."""
        return self.lines.index
