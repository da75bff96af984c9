"""What a scan makes of its trajectory, and which scans can make anything of it.

Beside `correct`, which loads all that adjusts, since most scans have no need of that.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from ..motion import AbstractMotion
from ..types.trajectory import Trajectory


@dataclass(frozen=True, eq=False)
class Corrected:
    """The poses of a scan, and what is to be said of them."""

    trajectory: Trajectory
    words: tuple[str, ...] = ()
    accuracy: str = ""
    """How well the poses are known, in words, where the scan has corrected them."""
    moved: float | None = None
    """How far they were moved, RMS [m]."""


def is_correctable(motion: AbstractMotion, lasers: Sequence[int]) -> bool:
    """Tell whether a scan may know better than its motion: of a straight pass two lasers do."""
    measured = motion.measure()
    return len(lasers) > 1 or (measured is not None and measured.is_placed)
