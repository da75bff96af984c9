"""The laser line in space."""

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from .arrays import FrameNumbers, Indices, Mask, Pixels, Points, Ratios, Scalars, SmallNumbers


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
    branch: SmallNumbers
    """Number of each point among those of its scan line, from 0, the strongest first."""

    def __len__(self) -> int:
        """Count the points."""
        return len(self.frame)

    @classmethod
    def concatenate(cls, profiles: Sequence["Profile"]) -> "Profile":
        """Put profiles one after another; none make a profile of length 0."""
        parts = [empty_profile(), *profiles]
        return cls(
            *(np.concatenate([getattr(part, c.name) for part in parts]) for c in fields(cls))
        )

    def __getitem__(self, which: Mask | Indices | slice) -> "Profile":
        """Pick some of the points."""
        return Profile(*(getattr(self, column.name)[which] for column in fields(self)))


def empty_profile() -> Profile:
    """Make the profile of a frame that shows no stripe."""
    ratio = np.zeros(0, np.float32)
    return Profile(
        frame=np.zeros(0, np.uint32),
        time=np.zeros(0),
        laser=np.zeros(0, np.uint8),
        pixels=np.zeros((0, 2)),
        points=np.zeros((0, 3)),
        sigma=ratio,
        signal=ratio,
        posterior=ratio,
        branch=np.zeros(0, np.uint8),
    )
