"""The laser line as seen in the picture."""

from dataclasses import dataclass, field

import numpy as np

from .arrays import FrameNumbers, Pixels, Ratios, Scalars, SmallNumbers
from .table import Table


@dataclass(frozen=True, eq=False, repr=False)
class Stripe(Table):
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
    blur_shift: Ratios = field(
        default_factory=lambda: np.zeros(0, np.float32), metadata={"may_be_left_out": True}
    )
    """How far the blur of the lens had drawn the centre along its scan line before the finder put
    it back [px]; 0 where the finder puts nothing back."""
    width: Ratios = field(
        default_factory=lambda: np.zeros(0, np.float32), metadata={"may_be_left_out": True}
    )
    """1σ of the stripe, at right angles to it, where the finder has learnt it [px]; else 0. The
    lens cannot blur by much more."""
