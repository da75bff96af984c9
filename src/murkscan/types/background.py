"""What a recording looks like where the stripe is not."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Background:
    """What an extractor has learnt from a recording before it looks for the stripe."""

    noise: float
    """Standard deviation of one pixel's grey level from frame to frame [grey levels]."""
