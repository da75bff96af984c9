"""The laser line as seen in the picture."""

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from .arrays import FrameNumbers, Indices, Mask, Pixels, Ratios, Scalars, SmallNumbers


@dataclass(frozen=True, eq=False)
class Stripe:
    """Centres of the laser line in one frame, or in several one after another; one a row.

    A frame without a stripe is a stripe of length 0.
    """

    frame: FrameNumbers
    """Index of the frame in its recording."""
    time: Scalars
    """Recording time of that frame [s]."""
    pixels: Pixels
    """Centres, in pixels of the full frame [px]."""
    sigma: Ratios
    """Standard deviation of each centre, along its scan line [px]."""
    signal: Ratios
    """Height of the stripe above its surroundings [grey levels]."""
    posterior: Ratios
    """Probability that this is the surface; 1 where the method gives none."""
    laser: SmallNumbers
    """Number of the laser in the rig."""
    branch: SmallNumbers
    """Number of this centre among those of its scan line, from 0, the strongest first."""

    def __len__(self) -> int:
        """Count the centres."""
        return len(self.frame)

    def __getitem__(self, which: Mask | Indices | slice) -> "Stripe":
        """Pick some of the centres."""
        return Stripe(*(getattr(self, column.name)[which] for column in fields(self)))

    @classmethod
    def concatenate(cls, stripes: Sequence["Stripe"]) -> "Stripe":
        """Put stripes one after another; none make a stripe of length 0."""
        parts = [empty_stripe(), *stripes]
        return cls(
            *(np.concatenate([getattr(part, c.name) for part in parts]) for c in fields(cls))
        )


def empty_stripe() -> Stripe:
    """Make the stripe of a frame that shows none."""
    ratio, number = np.zeros(0, np.float32), np.zeros(0, np.uint8)
    return Stripe(
        frame=np.zeros(0, np.uint32),
        time=np.zeros(0),
        pixels=np.zeros((0, 2)),
        sigma=ratio,
        signal=ratio,
        posterior=ratio,
        laser=number,
        branch=number,
    )
