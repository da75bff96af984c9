"""Mounts that the photos do not determine, and why."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from ..errors import Degenerate
from ..types.arrays import Vector
from ..types.pose import Pose
from ..types.rig_covariance import RigCovariance

_MAX_SHIFT_SIGMA = 0.05
"""Standard deviation of a direction of the translation above which it is not determined, over the
distance of the board."""
_MAX_TURN_SIGMA = np.radians(2.0)
"""The same of a turn [rad]."""
_LEAST_TURN = np.radians(3.0)
"""Spread of the vehicle's attitudes about an axis below which it did not turn about it [rad]."""


_CURE = "Take photos with the vehicle turned by 20 degrees or more about two different axes."


def refuse_undetermined(
    mount: RigCovariance, vehicles: Sequence[Pose], *, distance: float, is_place_measured: bool
) -> None:
    """Refuse a mount of which a part is not determined, and say which.

    Args:
        mount: Covariance of the mount's six parameters.
        vehicles: world_from_vehicle at each photo.
        distance: Of the board from the camera [m].
        is_place_measured: Whether the camera's place was measured, and need not be seen.

    Raises:
        Degenerate: A direction of the translation, or a turn, is not determined.
    """
    shift_sigma, shift_axis = _weakest(mount.matrix[:3, :3])
    turn_sigma, turn_axis = _weakest(mount.matrix[3:, 3:])
    if turn_sigma > _MAX_TURN_SIGMA:
        raise Degenerate(
            f"The {len(vehicles)} photos do not tell how the camera is turned about "
            f"{_as_words(turn_axis)} of its own axes (± {np.degrees(turn_sigma):.0f} degrees): "
            f"{_describe_turns(vehicles)} {_CURE}"
        )
    if shift_sigma > _MAX_SHIFT_SIGMA * distance and not is_place_measured:
        raise Degenerate(
            f"The {len(vehicles)} photos do not tell where along {_as_words(shift_axis)} of the "
            f"vehicle the camera sits (± {shift_sigma * 1e3:.0f} mm or more): "
            f"{_describe_turns(vehicles)} {_CURE} If it cannot turn so, measure where the lens "
            "sits and give it with --measured-mm and --measured-sigma-mm."
        )


def refuse_no_turns(vehicles: Sequence[Pose]) -> None:
    """Refuse a vehicle that never turned, of which not even a start can be told.

    Raises:
        Degenerate: It never turned.
    """
    if turning_axes(vehicles)[0][0] < _LEAST_TURN:
        raise Degenerate(
            f"The {len(vehicles)} photos do not tell how the camera sits on the vehicle: the "
            f"vehicle never turned. {_CURE}"
        )


def turning_axes(vehicles: Sequence[Pose]) -> tuple[Vector, Float[np.ndarray, "3 3"]]:
    """Give how far the vehicle turned about each of three axes [rad], most first, and the axes.

    The axes are in the vehicle's frame, one a row.
    """
    rotations = Rotation.from_matrix(np.stack([pose.rotation for pose in vehicles]))
    turns = (rotations.mean().inv() * rotations).as_rotvec()
    _, sizes, axes = np.linalg.svd(turns, full_matrices=True)
    spread = np.zeros(3)
    spread[: len(sizes)] = sizes / np.sqrt(len(turns))
    return spread, axes


def _weakest(covariance: Float[np.ndarray, "3 3"]) -> tuple[float, Vector]:
    variances, directions = np.linalg.eigh(covariance)
    return float(np.sqrt(max(variances[-1], 0.0))), directions[:, -1]


def _describe_turns(vehicles: Sequence[Pose]) -> str:
    spread, axes = turning_axes(vehicles)
    if spread[1] < _LEAST_TURN:
        return f"the vehicle turned about one axis only, {_as_words(axes[0])}."
    return "its turns are too small for the noise of the log and the corners."


def _as_words(axis: Vector) -> str:
    axis = axis * np.sign(axis[np.argmax(np.abs(axis))])
    return "(" + ", ".join(f"{part:.2f}" for part in axis + 0.0) + ")"
