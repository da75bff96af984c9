"""Which frames a part of the stripes covers."""

from dataclasses import dataclass

Skipped = tuple[int, int, str]
"""First frame that could not be read, how many, and why."""


@dataclass(frozen=True)
class PartNote:
    """The frames that one part of extract covers."""

    frames: tuple[int, ...]
    """Those that were read, by their index in the recording."""
    times: tuple[float, ...]
    """When each was taken [s]."""
    points: tuple[int, ...]
    """Stripe centres of each."""
    skips: tuple[Skipped, ...]
    points_of: tuple[int, ...] = ()
    """Stripe centres of each laser, in the order in which they were looked for."""
