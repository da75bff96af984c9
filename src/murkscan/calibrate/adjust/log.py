"""A log of the vehicle's poses as an observation: what it says of where each board must be.

The board stands still in the world, so each photo closes a circle::

    world ── world_from_vehicle (the log) ──▶ vehicle ── vehicle_from_camera ──▶ camera
      └───────────────── world_from_board ─────────────────▶ board ◀── seen by ────┘
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation, Slerp

from ...types.arrays import Scalars
from ...types.pose import Pose
from ...types.trajectory import Trajectory
from .observations import Boards

STAND = tuple(f"stand.{part}[{i}]" for part in ("translation", "turn") for i in range(3))
"""Parameters of where the board stands: along the world's axes [m], about the board's [rad]."""
CLOCK = "clock.offset"
"""What must be added to the photos' times [s]."""
MAX_CLOCK_SIGMA = 0.05
"""Standard deviation of the clock's offset above which the photos do not tell it [s]."""


class LogSampler:
    """Interpolates a log at times in any order; beyond its ends the log stands still."""

    def __init__(self, log: Trajectory) -> None:
        self.log = log
        self._rotations = log.attitudes
        self._slerp = Slerp(log.times, self._rotations) if len(log.times) > 1 else None

    @property
    def interval(self) -> float:
        """Median time from one pose to the next [s]."""
        return float(np.median(np.diff(self.log.times))) if len(self.log.times) > 1 else 1.0

    @property
    def clock_step(self) -> float:
        """Change of the clock over which derivatives are taken [s].

        Over less than the log's own interval its noise would be taken for speed.
        """
        return min(self.interval, MAX_CLOCK_SIGMA)

    def at(self, times: Scalars) -> tuple[Float[np.ndarray, "_ 3"], Rotation]:
        """Sample positions [m] and attitudes at times [s]; row i belongs to time i."""
        inside = np.clip(times, self.log.times[0], self.log.times[-1])
        positions = [np.interp(inside, self.log.times, p) for p in self.log.positions.T]
        if self._slerp is None:
            return np.stack(positions, axis=1), self._rotations[np.zeros(len(times), dtype=int)]
        return np.stack(positions, axis=1), self._slerp(inside)

    def poses_at(self, times: Scalars) -> tuple[Pose, ...]:
        """Sample world_from_vehicle at times [s]."""
        positions, rotations = self.at(times)
        matrices = rotations.as_matrix()
        return tuple(Pose(r, p) for r, p in zip(matrices, positions, strict=True))


@dataclass(frozen=True, eq=False)
class Stand:
    """Where the board stands, and by how much the photos' clock differs from the log's."""

    world_from_board: Pose
    clock_offset: float = 0.0
    """What must be added to the photos' times [s]."""

    def perturb(self, changes: Mapping[str, float]) -> "Stand":
        """Change the parameters of `STAND` and `CLOCK`."""
        step = np.array([changes.get(name, 0.0) for name in STAND])
        return Stand(
            move_pose(self.world_from_board, step),
            self.clock_offset + changes.get(CLOCK, 0.0),
        )


def move_pose(pose: Pose, step: Float[np.ndarray, "6"]) -> Pose:
    """Shift a pose along its target's axes [m], and turn it about its source's [rad]."""
    turn = Rotation.from_rotvec(step[3:]).as_matrix()
    return Pose(pose.rotation @ turn, pose.translation + step[:3])


@dataclass(frozen=True, eq=False)
class LoggedPoses:
    """The log, and when each photo was taken."""

    log: LogSampler
    times: Scalars
    """By the log's clock [s]."""

    def mounts(self, stand: Stand, boards: Boards) -> tuple[Float[np.ndarray, "p 3"], Rotation]:
        """Compute vehicle_from_camera as each photo alone has it: its place [m] and attitude."""
        positions, attitudes = self.log.at(self.times + stand.clock_offset)
        camera_from_board = Rotation.from_matrix(boards.rotations)
        board = stand.world_from_board
        rotations = Rotation.from_matrix(board.rotation) * camera_from_board.inv()
        places = board.translation - rotations.apply(boards.translations)
        return attitudes.inv().apply(places - positions), attitudes.inv() * rotations

    def residuals(self, mount: Pose, stand: Stand, boards: Boards) -> Float[np.ndarray, "p 6"]:
        """Compute how far each photo's camera is from its mount.

        The shift is along the vehicle's axes [m], the turn about the camera's [rad].
        """
        places, rotations = self.mounts(stand, boards)
        turns = (Rotation.from_matrix(mount.rotation).inv() * rotations).as_rotvec()
        return np.concatenate([places - mount.translation, turns], axis=1)

    def boards(self, mount: Pose, stand: Stand) -> tuple[Pose, ...]:
        """Compute camera_from_board of each photo as the log has it."""
        return tuple(
            (vehicle @ mount).inverse() @ stand.world_from_board
            for vehicle in self.log.poses_at(self.times + stand.clock_offset)
        )
