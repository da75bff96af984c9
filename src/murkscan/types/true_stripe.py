"""Where the stripe truly is, in a recording whose truth is known."""

from dataclasses import dataclass

from .arrays import FrameNumbers, Mask, Pixels, Points, Ratios, SmallNumbers
from .table import Table


@dataclass(frozen=True, eq=False, repr=False)
class TrueStripe(Table):
    """True centres of one frame, or of several one after another; none where none is seen."""

    frame: FrameNumbers
    """Index of the frame."""
    laser: SmallNumbers
    """Number of the laser in the rig."""
    branch: SmallNumbers
    """Number of this centre among those of its scan line, from 0: first those of the line itself,
    by their place."""
    is_reflected: Mask
    """Whether it belongs to the second line, which gloss throws."""
    pixels: Pixels
    """Projection of the sheet's middle on the surface [px]."""
    points: Points
    """The same on the surface, in the world frame [m]."""
    signal: Ratios
    """Peak of the stripe [grey levels]."""
    snr: Ratios
    """Signal-to-noise ratio of the stripe in its scan line."""
    crlb: Ratios
    """Standard deviation that no unbiased estimate from that scan line alone can beat [px]."""
