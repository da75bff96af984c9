"""Where an adjustment begins: a path with the log's attitude."""

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.spatial.transform import Rotation, Slerp

from ...types.arrays import Scalars
from ...types.navigation import Navigation, Readings
from .path import Path
from .spline import Knots


def first_path(navigation: Navigation, first: float, last: float, step: float) -> Path:
    """Make a path that has the log's attitude, and stands still: to be adjusted to the log.

    Args:
        navigation: The log.
        first: First time that the path has to hold [s].
        last: The last one [s].
        step: Length of a piece [s].
    """
    knots = Knots.over(first, last, step)
    nothing = np.zeros((knots.num_controls, 3))
    attitude = navigation.attitude
    if attitude is None:
        return Path(knots, nothing, nothing, Rotation.from_rotvec(nothing))
    return Path(knots, nothing, nothing, _smooth(attitude, knots.control_times, step))


def _smooth(attitude: Readings, times: Scalars, width: float) -> Rotation:
    """Give the log's attitude about each time, averaged over about half a width."""
    moments, which = np.unique(attitude.times, return_index=True)
    rotations = Rotation.from_euler("ZYX", attitude.values[which][:, ::-1])
    if len(moments) == 1:
        return Rotation.concatenate([rotations] * len(times))
    parts = 8
    fine = times[0] + (times[1] - times[0]) / parts * np.arange(parts * (len(times) - 1) + 1)
    quaternions = Slerp(moments, rotations)(np.clip(fine, moments[0], moments[-1])).as_quat()
    flips = np.sign(np.einsum("ij,ij->i", quaternions[1:], quaternions[:-1]))
    quaternions[1:] *= np.cumprod(flips)[:, None]
    return Rotation.from_quat(gaussian_filter1d(quaternions, parts / 2, axis=0)[::parts])
