"""The laser line in space."""

from dataclasses import dataclass, field

import numpy as np

from .arrays import FrameNumbers, Pixels, Points, Ratios, Scalars, SmallNumbers
from .table import Table


@dataclass(frozen=True, eq=False, repr=False)
class Profile(Table):
    """Surface points of one frame, or of several one after another; one a row."""

    frame: FrameNumbers
    """Index of the frame in its recording."""
    time: Scalars
    """Recording time of that frame [s]."""
    laser: SmallNumbers
    """Number of the laser in the rig."""
    pixels: Pixels
    """The stripe centres that the points come from [px]."""
    points: Points
    """Surface points in the camera frame [m]."""
    sigma: Ratios
    """Standard deviation of each point along its ray, the part independent between points [m]."""
    signal: Ratios
    """Height of the stripe above its surroundings [grey levels]."""
    posterior: Ratios
    """Probability that this is the surface."""
    branch: SmallNumbers
    """Number of each point among those of its scan line, from 0, the strongest first."""
    blur_shift: Ratios = field(
        default_factory=lambda: np.zeros(0, np.float32), metadata={"may_be_left_out": True}
    )
    """How much farther away the blur of the lens had moved each point before the finder put it back
    [m]; 0 where the finder puts nothing back."""
    width: Ratios = field(
        default_factory=lambda: np.zeros(0, np.float32), metadata={"may_be_left_out": True}
    )
    """1σ of the stripe in the picture, where the finder has learnt it [px]; else 0."""
