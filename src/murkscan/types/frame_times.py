"""Which frames of a recording could be read, and when they were taken."""

from dataclasses import dataclass

from .arrays import FrameNumbers, Scalars
from .short_repr import ShortRepr


@dataclass(frozen=True, eq=False, repr=False)
class FrameTimes(ShortRepr):
    """The frames that were read, with or without a stripe; one a row, in order."""

    frame: FrameNumbers
    """Index of the frame in its recording."""
    time: Scalars
    """Recording time [s]; the number of the picture where the recording has no times."""

    def __len__(self) -> int:
        """Count the frames."""
        return len(self.frame)
