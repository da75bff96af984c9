"""What a recording looks like where the stripe is not, and how the stripe stands out of it."""

from dataclasses import dataclass, field, replace


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

    def averaged(self, pixels: int) -> "Noise":
        """Give the noise of the mean of so many pixels.

        Its least variance stays: rounding and an encoder's blocks are alike in neighbours.
        """
        return replace(self, fixed=self.fixed / pixels, gain=self.gain / pixels)


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


@dataclass(frozen=True)
class Background:
    """What an extractor has learnt from a recording before it looks for the stripe."""

    noise: float
    """Standard deviation of one pixel's grey level from frame to frame [grey levels]."""
    levels: Noise | None = None
    """The same for each grey level; of extractors that weigh by it."""
    stripe: StripeShape | None = None
    """The stripe's look; of extractors that expect one."""
    attenuation: Attenuation | None = None
    """How murky the water is, where the glow tells."""
    remarks: tuple[str, ...] = ()
    """What is odd about the recording, with its cure; sentences for the user."""
