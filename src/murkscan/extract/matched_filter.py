"""Filters for ridges of known widths, blind to what slopes or bends beneath them."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy
from jaxtyping import Float, Float32

from .._kernels.matched_filter import score_pixels
from ..types.arrays import Ratios, Scalars
from ..types.background import PLAIN, Noise, Search, StripeShape
from .scan_lines import ScanLines

SKIRT = 2.5
"""Width of the skirt near the core, as a multiple of the core's."""
_STEPS = 8
"""Scan lines beyond a stripe's end over which its blur is looked for."""


@dataclass(frozen=True, eq=False)
class MatchedFilter:
    """A filter for one width, and the noise by which its answer is divided."""

    noise: Noise
    """Of its answer, by the level around it."""
    template: Ratios
    width: float
    """1σ of the stripe [px after averaging]."""
    binning: int = 1
    """Pixels that are averaged along a scan line before."""

    @classmethod
    def of(
        cls, width: float, noise: Noise, binning: int = 1, *, search: Search = PLAIN
    ) -> "MatchedFilter":
        """Make the filter of a width: a Gaussian without its part in 1, x and x², of norm 1.

        Args:
            width: 1σ of the stripe [px after averaging].
            noise: Of an averaged pixel.
            binning: Pixels that are averaged.
            search: How far the filter sees.
        """
        half = max(5, math.ceil(4 * width) + search.window)
        x = np.arange(-half, half + 1.0)
        return cls(noise, without_bend(np.exp(-0.5 * (x / width) ** 2)), width, binning)

    @property
    def reach(self) -> int:
        """Averaged pixels from a ridge up to which it has side lobes."""
        return len(self.template) // 2 + 4

    def respond(self, lines: ScanLines) -> Float32[np.ndarray, "length lines"]:
        """Score each averaged pixel, in standard deviations of the noise."""
        seen = lines.binned(self.binning)
        return score_pixels(seen.signal, seen.levels, self.template, self.noise.as_law())


def without_bend(shape: Scalars) -> Ratios:
    """Make a template of a shape: without its part in 1, x and x², and of norm 1."""
    x = np.arange(len(shape)) - 0.5 * (len(shape) - 1)
    smooth = np.stack([x**0, x, x**2], axis=1)
    rest = shape - smooth @ np.linalg.lstsq(smooth, shape, rcond=None)[0]
    return (rest / np.linalg.norm(rest)).astype(np.float32)


@dataclass(frozen=True, eq=False)
class FilterBank:
    """One filter for each width that the recording's stripe has."""

    filters: tuple[MatchedFilter, ...]
    noise: Noise
    """Of a pixel."""
    shapes: tuple[StripeShape, ...]
    """What each filter looks for."""
    search: Search
    """How deep in the noise."""

    @classmethod
    def of(
        cls, shapes: Sequence[StripeShape], noise: Noise, search: Search = PLAIN
    ) -> "FilterBank":
        """Make a filter for each shape, the first one's first."""
        return cls(
            tuple(
                MatchedFilter.of(
                    s.width, s.clutter or noise.averaged(s.binning), s.binning, search=search
                )
                for s in shapes
            ),
            noise,
            tuple(shapes),
            search,
        )

    def tails(self, lines: ScanLines) -> Float[np.ndarray, "shapes steps"]:
        """Give how high a stripe's blur is beyond its end, as a share of the stripe's height.

        The light that core and skirt scatter across a stripe they scatter along it as well: beyond
        the end of a line, a bell of 1σ w has fallen to erfc(d / √2 w) / 2 at the distance d. An end
        lies half way between the last scan line that it lights and the next.
        """
        upright = 1.0 / math.hypot(1.0, lines.slope)
        scale = upright * lines.stretch / lines.binning / lines.line_step
        widths = np.array([scale * each.width * each.binning for each in self.shapes])[:, None]
        skirts = np.array([each.skirt for each in self.shapes])[:, None]
        away = np.arange(_STEPS) + 0.5
        core, skirt = (
            0.5 * scipy.special.erfc(away / (math.sqrt(2) * w)) for w in (widths, SKIRT * widths)
        )
        return (core + skirts * skirt) / (1.0 + skirts)

    def score(self, lines: ScanLines) -> "Scored":
        """Score each pixel of a frame by each filter."""
        return Scored(lines, tuple(each.respond(lines) for each in self.filters))


@dataclass(frozen=True, eq=False)
class Scored:
    """How much each pixel of a frame looks like the middle of a stripe, by each filter."""

    lines: ScanLines
    scores: tuple[Float32[np.ndarray, "_ lines"], ...]
    """In standard deviations of the noise; each filter has its own averaged pixels."""

    @property
    def index(self) -> int:
        """Number of the frame in its recording."""
        return self.lines.index
