"""The laser line in space."""

from dataclasses import dataclass, fields

from .arrays import FrameNumbers, Mask, Pixels, Points, Ratios, Scalars, SmallNumbers


@dataclass(frozen=True, eq=False)
class Profile:
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

    def __len__(self) -> int:
        """Count the points."""
        return len(self.frame)

    def __getitem__(self, which: Mask | slice) -> "Profile":
        """Pick some of the points."""
        return Profile(*(getattr(self, column.name)[which] for column in fields(self)))
