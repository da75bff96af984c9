"""Where the stripe truly is, in a recording whose truth is known."""

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from .arrays import FrameNumbers, Pixels, Points, Ratios, SmallNumbers


@dataclass(frozen=True, eq=False)
class TrueStripe:
    """True centres of one frame, or of several one after another; none where none is seen."""

    frame: FrameNumbers
    """Index of the frame."""
    laser: SmallNumbers
    """Number of the laser in the rig."""
    pixels: Pixels
    """Projection of the sheet's middle on the surface [px]."""
    points: Points
    """The same on the surface, in the world frame [m]."""
    signal: Ratios
    """Peak of the stripe [grey levels]."""

    def __len__(self) -> int:
        """Count the centres."""
        return len(self.frame)

    @classmethod
    def concatenate(cls, stripes: Sequence["TrueStripe"]) -> "TrueStripe":
        """Put true stripes one after another; none make one of length 0."""
        number, place = np.zeros(0, np.uint32), np.zeros((0, 3))
        empty = cls(number, number.astype(np.uint8), place[:, :2], place, np.zeros(0, np.float32))
        parts = [empty, *stripes]
        return cls(
            *(np.concatenate([getattr(part, c.name) for part in parts]) for c in fields(cls))
        )
