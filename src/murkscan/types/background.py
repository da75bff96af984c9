"""What a recording looks like where the stripe is not, and how the stripe stands out of it."""

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float32

from .arrays import Scalars
from .short_repr import ShortRepr


@dataclass(frozen=True)
class Noise:
    """How much a pixel's grey level fluctuates at each level."""

    fixed: float
    """Variance at level 0 [grey levels²]: reading and rounding."""
    gain: float
    """Variance added by each grey level [grey levels]: the light's own."""
    white: float
    """Level from which a pixel is saturated [grey levels]."""

    least: float = 1 / 12 + 0.02
    """Variance that no pixel is below [grey levels²]: that of rounding, and of what is rounded."""
    relative: float = 0.0
    """Variance as a share of the level squared: speckle, texture, unequal pixels."""

    rows: float = 0.0
    """Standard deviation of what all pixels of an image row have in common [grey levels]."""
    shared: bool = False
    """Whether neighbouring pixels share it, by a filled-in mosaic or an encoder."""
    smoothed: bool = False
    """Whether an encoder has smoothed it away, so that what is left are blocks that differ."""

    def averaged(self, pixels: int) -> "Noise":
        """Compute the noise of the mean of so many pixels.

        Its least variance stays: rounding and an encoder's blocks are alike in neighbours.
        """
        return replace(
            self,
            fixed=self.fixed / pixels,
            gain=self.gain / pixels,
            relative=self.relative / pixels,
        )

    def variance(self, level: np.ndarray) -> np.ndarray:
        """Compute the variance of a pixel at each level [grey levels²]."""
        return np.maximum(self.fixed + level * (self.gain + level * self.relative), self.least)

    def typical(self, image: np.ndarray) -> float:
        """Compute the standard deviation of the noise at a picture's median level [grey levels]."""
        return float(np.sqrt(self.variance(np.array([np.median(image)]))[0]))

    def as_law(self) -> Scalars:
        """List what a compiled loop needs: fixed, gain, relative, least, white."""
        return np.array([self.fixed, self.gain, self.relative, self.least, self.white])


@dataclass(frozen=True)
class StripeShape:
    """What a recording's stripe looks like across its scan lines: a core on a skirt.

    Both are Gaussians; the skirt is light that the water has scattered forward.
    """

    width: float
    """1σ of the core [px of the binned picture]."""
    skirt: float
    """Height of the skirt as a share of the core's."""
    binning: int
    """Pixels along a scan line that are averaged first, where a stripe is wide."""
    misfit: float
    """Factor by which true centres scatter more than the noise explains, at least 1."""
    floor: float
    """What they scatter beside that: speckle and texture [px of the binned picture]."""
    clutter: Noise | None = None
    """Variance of a matched filter's answer where there is no stripe, by the level around it: noise
    and all that a picture has of this width beside; that of the noise alone unless given."""
    blur: float = 0.0
    """Variance of the blur along the stripe, by which brighter scan lines draw their neighbours'
    centres where it slants [px² of the full frame]."""
    rough: float = 1.0
    """What a surface's roughness scatters centres by from scan line to scan line, at most, as far
    as noise lets it be seen [px of the binned picture]."""


@dataclass(frozen=True)
class Search:
    """How deep in the noise ridges are looked for."""

    least: float = 2.5
    """Score from which a ridge is looked at [standard deviations]."""
    most: int = 16
    """Ridges a scan line; the highest are kept. With six, text and bubbles crowd the stripe out."""
    window: int = 2
    """Pixels that a filter sees on both sides beyond four widths of the stripe: the more, the less
    of a faint stripe is lost to the bend that filters are blind to, and the more glow and texture
    are taken for one."""
    rim: float = 1.5
    """Widths from the picture's edge within which nothing shows on one side: no stripe is told from
    the picture's own rim there."""


PLAIN = Search()
"""As deep as single scan lines show a stripe."""


@dataclass(frozen=True, eq=False, repr=False)
class FixedPattern(ShortRepr):
    """What is fixed to the picture and not to the scene: rim, dirt, scratches, ghosts, text."""

    first_row: int
    """First row of the full frame in the pictures that have it; fields have their own."""
    levels: Float32[np.ndarray, "h w"]
    """What it adds to each pixel, beside what is smooth [grey levels]."""
    overlay: Bool[np.ndarray, "h w"] | None = None
    """Where a display writes over the picture, so that nothing of the scene is seen."""

    @cached_property
    def transposed(self) -> "FixedPattern":
        """The same with its rows and columns exchanged."""
        overlay = None if self.overlay is None else np.ascontiguousarray(self.overlay.T)
        return FixedPattern(self.first_row, np.ascontiguousarray(self.levels.T), overlay)


@dataclass(frozen=True)
class Attenuation:
    """How murky the water was."""

    effective: float = field(metadata={"unit": "per_m"})
    """What the sheet's own glow fades by [1/m]."""
    low: float = field(metadata={"unit": "per_m"})
    high: float = field(metadata={"unit": "per_m"})
    """Ends of an interval that holds the water's beam attenuation c [1/m]."""

    @property
    def is_telling(self) -> bool:
        """Tell whether the interval says more than that the water is murky."""
        return self.low > 0.1 * self.high


@dataclass(frozen=True, eq=False, repr=False)
class Background(ShortRepr):
    """What an extractor has learnt from a recording before it looks for the stripe."""

    noise: float
    """Standard deviation of one pixel's grey level from frame to frame [grey levels]."""
    levels: Noise | None = None
    """The same for each grey level; of extractors that weigh by it."""
    shapes: tuple[StripeShape, ...] = ()
    """The stripe's looks, the commonest first; of extractors that expect some."""
    rates: Scalars = field(default_factory=lambda: np.zeros(0))
    """How often clutter of each height is met; of extractors that weigh by it."""
    stays: Scalars = field(default_factory=lambda: np.zeros(0))
    """Share of the clutter of each height that other frames show in its place, too."""
    search: Search = PLAIN
    """How deep is looked; of extractors that look deeper where the stripe is faint."""
    fixed: tuple[FixedPattern, ...] = ()
    """What stays in the picture whatever the scene; one for each kind of field."""
    attenuation: Attenuation | None = None
    """How murky the water is, where the glow tells."""
    remarks: tuple[str, ...] = ()
    """What is odd about the recording, with its cure; sentences for the user."""
    scale: float = 1.0
    """Grey levels that are as much as one of 8 bits: 16, where the pictures use 12 bits."""

    @property
    def water(self) -> Attenuation | None:
        """Give how murky the water is where that can be told: in clear or very murky water, not."""
        return self.attenuation if self.attenuation and self.attenuation.is_telling else None
