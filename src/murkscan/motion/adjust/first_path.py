"""Where an adjustment begins: a path with the log's attitude, or one that has been registered."""

from dataclasses import replace

import numpy as np
from jaxtyping import Float
from scipy import sparse
from scipy.ndimage import gaussian_filter1d
from scipy.sparse.linalg import spsolve
from scipy.spatial.transform import Rotation, Slerp

from ...types.arrays import Scalars
from ...types.navigation import Navigation
from ...types.trajectory import Trajectory
from .path import Path
from .spline import Knots, evaluate_rotation

_CLOCK_SIGMAS = 3.0
"""Standard deviations by which a log's clock may be off for its readings still to lie on a path:
were readings to leave it, or to come to it, as the clock is moved, that would look like knowledge
of the clock, and a place that was measured once, where the way begins, might be lost."""
_LONGEST_MARGIN = 1.0
"""Longest time that a path goes on before and behind its profiles [s]: recorders are no later."""
_STIFF = 1e-3
"""Weight of a control value's second difference beside one pose: where there are poses, none."""


def first_path(
    navigation: Navigation,
    first: float,
    last: float,
    step: float,
    start: Trajectory | None = None,
) -> Path:
    """Make a path that has the log's attitude, and stands still: to be adjusted to the log.

    Args:
        navigation: The log.
        first: First time that the path has to hold [s].
        last: The last one [s].
        step: Length of a piece [s].
        start: world_from_vehicle, whose attitude is taken in place of the log's.
    """
    margin = min(_CLOCK_SIGMAS * navigation.accuracy.clock_offset, _LONGEST_MARGIN)
    knots = Knots.over(first, last, step, margin)
    nothing = np.zeros((knots.num_controls, 3))
    if start is not None:
        turns = start.attitudes
        return Path(knots, nothing, nothing, _smooth(start.times, turns, knots, step))
    attitude = navigation.attitude
    if attitude is None:
        return Path(knots, nothing, nothing, Rotation.from_rotvec(nothing))
    turns = Rotation.from_euler("ZYX", attitude.values[:, ::-1])
    return Path(knots, nothing, nothing, _smooth(attitude.times, turns, knots, step))


def fit_path(path: Path, way: Trajectory) -> Path:
    """Lay a path where a vehicle went, as far as its pieces can follow it.

    Args:
        path: Its knots and its reference attitude stay.
        way: world_from_vehicle, at times within the knots.
    """
    reference = evaluate_rotation(path.knots, path.reference, way.times)
    turns = way.attitudes * reference.inv()
    both = _fit(path.knots, way.times, np.hstack([way.positions, turns.as_rotvec()]))
    return replace(path, positions=both[:, :3], turns=both[:, 3:])


def _fit(
    knots: Knots, times: Scalars, values: Float[np.ndarray, "n d"]
) -> Float[np.ndarray, "k d"]:
    """Fit the control values of a spline by least squares, held where nothing else holds them."""
    first, weights = knots.weights(times)
    rows = np.repeat(np.arange(len(times)), 4)
    columns = (first[:, None] + np.arange(4)).ravel()
    shape = (len(times), knots.num_controls)
    design = sparse.csr_matrix((weights.ravel(), (rows, columns)), shape=shape)
    bends = sparse.diags([1.0, -2.0, 1.0], [0, 1, 2], shape=(shape[1] - 2, shape[1]))
    matrix = design.T @ design + _STIFF * bends.T @ bends
    return np.asarray(spsolve(matrix.tocsc(), design.T @ values)).reshape(shape[1], -1)


def _smooth(moments: Scalars, rotations: Rotation, knots: Knots, width: float) -> Rotation:
    """Give an attitude about each control value, averaged over about half a width."""
    moments, which = np.unique(moments, return_index=True)
    rotations, times = rotations[which], knots.control_times
    if len(moments) == 1:
        return Rotation.concatenate([rotations] * len(times))
    parts = 8
    fine = times[0] + (times[1] - times[0]) / parts * np.arange(parts * (len(times) - 1) + 1)
    quaternions = Slerp(moments, rotations)(np.clip(fine, moments[0], moments[-1])).as_quat()
    flips = np.sign(np.einsum("ij,ij->i", quaternions[1:], quaternions[:-1]))
    quaternions[1:] *= np.cumprod(flips)[:, None]
    return Rotation.from_quat(gaussian_filter1d(quaternions, parts / 2, axis=0)[::parts])
