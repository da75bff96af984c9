"""What one photo tells an adjustment: a board's corners, and perhaps a stripe on it."""

from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float

from ..types.arrays import Pixels, Points
from ..types.pose import Pose


def _no_pixels() -> Float[np.ndarray, "m 2"]:
    return np.zeros((0, 2))


@dataclass(frozen=True, eq=False)
class Sighting:
    """Points of a board whose places on the board are known, and the laser's stripe across it."""

    name: str
    """Name of the photo."""
    corners: Pixels
    """Where the photo shows the board's points [px]."""
    points: Points
    """The same points in the board's frame [m]."""
    camera_from_board: Pose
    """Where the board is, at least roughly."""
    stripe: Float[np.ndarray, "m 2"] = field(default_factory=_no_pixels)
    """Stripe centres on the board's plane [px]; none where the photo is for the camera only."""
    laser: int = 0
    """Number of the laser that makes the stripe."""
