"""Whether the log's clock and the camera's agree, told without knowing the mount.

However the camera sits on the vehicle, from one photo to another both turn by the same angle. So
the angles tell at which shift of the clock the poses belong to the photos.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from ..types.arrays import Scalars
from ..types.pose import Pose
from .adjust.log import LogSampler

ANGLES_AGREE = np.radians(0.5)
"""Median misfit of the angles up to which no other clock is looked for [rad]."""
_FARTHEST = 60.0
"""Shift of the clock up to which the angles are tried [s]."""
_FINENESS = 600
"""Shifts tried on each side of 0."""
_INSIDE = 0.8
"""Share of the photos that the log must cover at a shift that is tried."""


@dataclass(frozen=True)
class ClockCheck:
    """How well the angles that the camera and the vehicle turned by agree."""

    misfit: float
    """Median difference of the angles, over all pairs of photos, as the clocks are [rad]."""
    best_offset: float
    """What must be added to the photos' times for the least difference [s]."""
    best_misfit: float
    """The median difference at that offset [rad]."""


def check_clock(times: Scalars, log: LogSampler, camera_from_boards: Sequence[Pose]) -> ClockCheck:
    """Compare the angles as the clocks are, and if they disagree at offsets of up to a minute.

    Args:
        times: When each photo was taken, by the log's clock [s].
        log: Poses world_from_vehicle.
        camera_from_boards: Where the board was in each photo.

    References:
        Tsai and Lenz, A new technique for fully autonomous and efficient 3D robotics hand/eye
        calibration, IEEE Transactions on Robotics and Automation 5(3), 1989, lemma on the angle.
    """
    rotations = Rotation.from_matrix(np.stack([pose.rotation for pose in camera_from_boards]))
    seen = _angles(rotations.as_quat())
    misfit = _misfit(times, log, seen)
    if misfit <= ANGLES_AGREE:
        return ClockCheck(misfit, 0.0, misfit)
    steps = np.arange(1, _FINENESS + 1) * (_FARTHEST / _FINENESS)
    offsets = np.concatenate([-steps[::-1], steps])
    misfits = np.array([_misfit(times + offset, log, seen) for offset in offsets])
    best = int(np.argmin(misfits))
    return ClockCheck(misfit, float(offsets[best]), float(misfits[best]))


def _misfit(times: Scalars, log: LogSampler, seen: Float[np.ndarray, "n n"]) -> float:
    inside = (times >= log.log.times[0]) & (times <= log.log.times[-1])
    if np.mean(inside) < _INSIDE:
        return np.inf
    logged = _angles(log.at(times[inside])[1].as_quat())
    difference = np.abs(logged - seen[np.ix_(inside, inside)])
    return float(np.median(difference[np.triu_indices(len(logged), 1)]))


def _angles(quaternions: Float[np.ndarray, "n 4"]) -> Float[np.ndarray, "n n"]:
    """Give the angle between each two attitudes [rad]."""
    return 2 * np.arccos(np.minimum(np.abs(quaternions @ quaternions.T), 1.0))
