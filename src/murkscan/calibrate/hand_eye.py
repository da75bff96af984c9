"""Where the camera sits on the vehicle, in closed form: the start of the adjustment."""

from collections.abc import Sequence
from itertools import combinations

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from ..types.arrays import Matrix3, Scalars
from ..types.pose import Pose

_NUM_ROUNDS = 5
"""Rounds of weights: a photo whose pose is wrong has lost its say after three."""
_ONE_AXIS = 1e-3
"""Turns about the second axis over those about the first, squared, below which there is one."""
_NUM_SPINS = 24
"""Spins about a single axis that are tried."""
_GAUSSIAN = 1.4826
"""Standard deviation of Gaussian noise as a multiple of its median absolute value."""
_LEAST_TURN, _LEAST_SHIFT = 1e-6, 1e-7
"""Misfits that count as none [rad], [m], so that data without noise do not reject each other."""


def solve_hand_eye(world_from_vehicles: Sequence[Pose], camera_from_boards: Sequence[Pose]) -> Pose:
    """Solve A X = X B for the mount X, each pair of photos giving one A and one B.

    Pairs that do not fit lose their weight. Directions in which the pairs say nothing are left
    at zero: whether there are any is the adjustment's to find out.

    Args:
        world_from_vehicles: What the log says at each photo.
        camera_from_boards: Where the board was in each photo.

    Returns:
        vehicle_from_camera.

    References:
        Park and Martin, Robot sensor calibration: solving AX = XB on the Euclidean group, IEEE
        Transactions on Robotics and Automation 10(5), 1994; Holland and Welsch, Robust regression
        using iteratively reweighted least-squares, 1977, for the weights (Cauchy's).
    """
    pairs = list(combinations(range(len(camera_from_boards)), 2))
    vehicles, boards = world_from_vehicles, camera_from_boards
    a = [vehicles[j].inverse() @ vehicles[i] for i, j in pairs]
    b = [boards[j] @ boards[i].inverse() for i, j in pairs]
    candidates = [_solve_translation(a, b, rotation) for rotation in _solve_rotation(a, b)]
    return min(candidates, key=lambda candidate: candidate[1])[0]


def _solve_rotation(a: Sequence[Pose], b: Sequence[Pose]) -> list[Matrix3]:
    """Give the mount's rotation; several where all turns are about one axis."""
    turns_a, turns_b = _turns(a), _turns(b)
    weights = np.ones(len(a))
    for _ in range(_NUM_ROUNDS):
        moment = (turns_a * weights[:, None]).T @ turns_b
        u, sizes, vt = np.linalg.svd(moment)
        rotation = u @ np.diag([1.0, 1.0, np.linalg.det(u @ vt)]) @ vt
        misfits = np.linalg.norm(turns_a - turns_b @ rotation.T, axis=1)
        weights = _cauchy(misfits, _LEAST_TURN)
    if sizes[1] > _ONE_AXIS * sizes[0]:
        return [rotation]
    spins = np.linspace(0, 2 * np.pi, _NUM_SPINS, endpoint=False)
    return [Rotation.from_rotvec(spin * u[:, 0]).as_matrix() @ rotation for spin in spins]


def _solve_translation(
    a: Sequence[Pose], b: Sequence[Pose], rotation: Matrix3
) -> tuple[Pose, float]:
    """Give the mount with this rotation, and how badly the shifts of the median pair fit [m]."""
    factors = np.stack([pose.rotation - np.eye(3) for pose in a])
    rights = np.stack([rotation @ q.translation - p.translation for p, q in zip(a, b, strict=True)])
    weights = np.ones(len(a))
    for _ in range(_NUM_ROUNDS):
        root = np.sqrt(weights)
        solution = np.linalg.lstsq(
            (factors * root[:, None, None]).reshape(-1, 3),
            (rights * root[:, None]).ravel(),
            rcond=1e-6,
        )[0]
        misfits = np.linalg.norm(factors @ solution - rights, axis=1)
        weights = _cauchy(misfits, _LEAST_SHIFT)
    return Pose(rotation, np.asarray(solution)), float(np.median(misfits))


def _turns(poses: Sequence[Pose]) -> Float[np.ndarray, "n 3"]:
    return Rotation.from_matrix(np.stack([pose.rotation for pose in poses])).as_rotvec()


def _cauchy(misfits: Scalars, least: float) -> Scalars:
    scale = max(2.385 * _GAUSSIAN * float(np.median(misfits)), least)
    return 1 / (1 + (misfits / scale) ** 2)


def mean_pose(poses: Sequence[Pose]) -> Pose:
    """Compute the pose that the others scatter about: mean rotation, median translation."""
    rotations = Rotation.from_matrix(np.stack([pose.rotation for pose in poses]))
    places = np.stack([pose.translation for pose in poses])
    return Pose(rotations.mean().as_matrix(), np.median(places, axis=0))
