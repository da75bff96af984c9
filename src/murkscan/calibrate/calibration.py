"""One step of a rig's calibration: what was found, on which photos, and what it is worth."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..types.arrays import Pixels, Scalars
from ..types.rig import Rig
from .adjust.log import CLOCK, LoggedPoses
from .adjust.observations import Sighting
from .adjust.solve import Adjustment

MIN_VIEWS = 4
"""Views below which neither a camera, nor a port, nor a mount is calibrated."""
_MAX_LEFT_OUT = 0.25
"""Share of the views that may be left out."""


@dataclass(frozen=True, eq=False)
class Calibration:
    """What one step found: a camera, a port, lasers or a mount."""

    step: str
    """What was calibrated: camera, port, laser or mount."""
    adjustment: Adjustment
    """The rig, its covariance and the residuals."""
    wanted: tuple[str, ...]
    """The parameters that the photos were taken for; others are adjusted along."""
    sightings: tuple[Sighting, ...]
    """The photos used, with the board where it was found to be."""
    left_out: tuple[str, ...] = ()
    """Names of photos left out, since they fit far worse than the others."""
    lasers: tuple[int, ...] = ()
    """Numbers of the lasers that were calibrated."""
    is_camera_kept: bool = False
    """Whether the camera was left as it was, because these photos contradict it; its errors are
    in the covariance all the same."""
    logged: LoggedPoses | None = None
    """The log of the vehicle's poses at these photos, for a mount."""

    @classmethod
    def of(
        cls, step: str, found: Adjustment, wanted: Sequence[str], seen: Sequence[Sighting]
    ) -> "Calibration":
        """Make one whose sightings have their boards where the adjustment puts them."""
        placed = tuple(
            replace(sighting, camera_from_board=pose)
            for sighting, pose in zip(seen, found.camera_from_boards, strict=True)
        )
        return cls(step, found, tuple(wanted), placed)

    @property
    def rig(self) -> Rig:
        """The rig as it was found, with its covariance."""
        return self.adjustment.rig

    @property
    def sigma(self) -> Scalars:
        """Standard deviation of each of the wanted parameters."""
        return self.adjustment.worth.covariance.select(self.wanted).sigma

    @property
    def rms(self) -> float:
        """Root mean square distance of a corner from its projection [px]."""
        return self.adjustment.rms

    @property
    def corners(self) -> Pixels:
        """All corners of the photos used [px]."""
        return np.concatenate([sighting.corners for sighting in self.sightings])

    @property
    def depths(self) -> tuple[float, ...]:
        """Depth z of the middle of the board in each photo [m]."""
        return tuple(
            float((s.camera_from_board @ s.points.mean(axis=0)[None])[0, 2]) for s in self.sightings
        )

    @property
    def clock_sigma(self) -> float | None:
        """Standard deviation of the clock's offset [s]; None where the photos do not tell it."""
        covariance = self.adjustment.worth.covariance
        known = CLOCK in covariance.names
        return float(covariance.select([CLOCK]).sigma[0]) if known else None


def find_outlier(rms: Sequence[float], num_left_out: int, *, outlier: float) -> int | None:
    """Find the view that stands out from the others; None if none does or too many went already.

    Args:
        rms: What each view is off.
        num_left_out: Views left out already.
        outlier: Multiple of the median from which a view stands out.
    """
    num_views = len(rms) + num_left_out
    may_leave_out = min(int(_MAX_LEFT_OUT * num_views), num_views - MIN_VIEWS)
    worst = int(np.argmax(rms))
    stands_out = rms[worst] > outlier * float(np.median(rms))
    return worst if stands_out and num_left_out < may_leave_out else None
