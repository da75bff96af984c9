"""Where the stripe truly is, in a recording whose truth is known."""

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from .arrays import FrameNumbers, Mask, Pixels, Points, Ratios, SmallNumbers


@dataclass(frozen=True, eq=False)
class TrueStripe:
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

    def __len__(self) -> int:
        """Count the centres."""
        return len(self.frame)

    @classmethod
    def concatenate(cls, stripes: Sequence["TrueStripe"]) -> "TrueStripe":
        """Put true stripes one after another; none make one of length 0."""
        small, ratio, place = np.zeros(0, np.uint8), np.zeros(0, np.float32), np.zeros((0, 3))
        frame, mask = np.zeros(0, np.uint32), np.zeros(0, bool)
        empty = cls(frame, small, small, mask, place[:, :2], place, ratio, ratio, ratio)
        parts = [empty, *stripes]
        return cls(
            *(np.concatenate([getattr(part, c.name) for part in parts]) for c in fields(cls))
        )
