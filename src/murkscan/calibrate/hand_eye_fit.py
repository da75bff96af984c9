"""The adjustment of mount, board and clock to the corners of all photos."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from ..optics import project
from ..types.arrays import Scalars, Vector
from ..types.camera import Camera
from ..types.pose import Pose
from .board import Chessboard
from .hand_eye_noise import Weighed, weigh_photos
from .logged import LogSampler
from .view import BoardView

MAX_CLOCK_SIGMA = 0.05
"""Standard deviation of the clock's offset above which the photos do not tell it [s]."""
_NUM_POSES = 12
"""Parameters of mount and board; behind them stands the clock's offset, where it is fitted."""
_MAX_INTERVAL = 0.5
"""Time between the log's poses above which it does not say how the vehicle moved in between [s]."""
_NUM_ROUNDS = 6
"""Rounds of weighing; the noise of a pose settles in three or four."""
_UNSEEN = 1e3
"""Misfit of a corner that a step of the adjustment puts behind the camera [px]."""
_SMALL = 1e-6
"""Change of a parameter for a derivative [m], [rad]."""

Step = Float[np.ndarray, "p"]
"""Change of mount and board, each shift [m] and turn [rad], perhaps with the clock's offset [s]."""
Jacobian = Float[np.ndarray, "n p"]
"""Change of each misfit with each parameter."""


@dataclass(frozen=True, eq=False)
class Photographed:
    """One photo of the board."""

    view: BoardView
    """Its corners."""
    time: float
    """When it was taken, by the log's clock [s]."""
    camera_from_board: Pose
    """Where the board was, by this photo alone."""

    def logged(self, log: LogSampler, offset: float = 0.0) -> Pose:
        """Give world_from_vehicle, `offset` [s] after the photo's time."""
        positions, rotations = log.at(np.array([self.time + offset]))
        return Pose(rotations.as_matrix()[0], positions[0])


@dataclass(frozen=True, eq=False)
class HandEyeFit:
    """The best mount, board and clock, and how well they are known."""

    photos: tuple[Photographed, ...]
    """The photos that were fitted."""
    vehicles: tuple[Pose, ...]
    """world_from_vehicle at each of them, by the adjusted clock."""
    poses: tuple[Pose, Pose]
    """vehicle_from_camera and world_from_board."""
    middle: Vector
    """Middle of the board, in its own frame [m]."""
    residuals: tuple[Float[np.ndarray, "_ 2"], ...]
    """Corner as found minus corner as projected, of each photo [px]."""
    mount_covariance: Float[np.ndarray, "6 6"]
    """Of the mount: translation along the vehicle's axes [m], turn about the camera's [rad]."""
    response: Float[np.ndarray, "6 m"]
    """Change of the mount with each coordinate of a found corner, photo after photo."""
    clock_offset: float = 0.0
    """What must be added to the photos' times [s]."""
    clock_sigma: float | None = None
    """Its standard deviation [s]; None where the photos do not tell, and the offset is held at 0.
    """

    @property
    def view_rms(self) -> Scalars:
        """Root mean square distance of a corner from its projection, of each photo [px]."""
        return np.array([np.sqrt(np.mean(np.sum(r**2, axis=1))) for r in self.residuals])

    @property
    def distance(self) -> float:
        """Median distance of the board from the camera [m]."""
        middles = [photo.camera_from_board @ self.middle[None] for photo in self.photos]
        return float(np.median(np.linalg.norm(np.concatenate(middles), axis=1)))

    def closures(self) -> tuple[Scalars, Scalars]:
        """Give how far each photo sees the board from its place: its middle [m], its turn [rad]."""
        mount, world_from_board = self.poses
        shifts, turns = [], []
        for photo, vehicle in zip(self.photos, self.vehicles, strict=True):
            off = world_from_board.inverse() @ vehicle @ mount @ photo.camera_from_board
            shifts.append(np.linalg.norm(off @ self.middle[None] - self.middle))
            turns.append(np.linalg.norm(Rotation.from_matrix(off.rotation).as_rotvec()))
        return np.array(shifts), np.array(turns)

    def with_mount(self, mount: Pose) -> "HandEyeFit":
        """Give the fit with another mount; the board goes with it as well as it can."""
        boards = [
            vehicle @ mount @ photo.camera_from_board
            for photo, vehicle in zip(self.photos, self.vehicles, strict=True)
        ]
        rotations = Rotation.from_matrix(np.stack([pose.rotation for pose in boards]))
        rotation = rotations.mean().as_matrix()
        place = np.median(np.concatenate([pose @ self.middle[None] for pose in boards]), axis=0)
        return replace(self, poses=(mount, Pose(rotation, place - rotation @ self.middle)))


def move(pose: Pose, step: Step) -> Pose:
    """Shift a pose along its target's axes [m], and turn it about its source's [rad]."""
    turn = Rotation.from_rotvec(step[3:6]).as_matrix()
    return Pose(pose.rotation @ turn, pose.translation + step[:3])


@dataclass(frozen=True, eq=False)
class HandEyeProblem:
    """What is adjusted: corners in photos, a log and a camera."""

    photos: tuple[Photographed, ...]
    """The photos."""
    log: LogSampler
    """Poses world_from_vehicle."""
    board: Chessboard
    """The board."""
    camera: Camera
    """The camera, which is taken as known."""
    index: float | None
    """Refractive index of what lies outside the camera's port."""

    def without(self, number: int) -> "HandEyeProblem":
        """Leave out one photo."""
        kept = self.photos[:number] + self.photos[number + 1 :]
        return replace(self, photos=kept)

    def fit(self, start: tuple[Pose, Pose]) -> HandEyeFit:
        """Adjust mount, board and clock so that the corners are seen where they were found.

        Args:
            start: vehicle_from_camera and world_from_board to start from.
        """
        found, weighed = self._refine(start, self._approach(start))
        clock_sigma = None
        if self.log.interval <= _MAX_INTERVAL:
            timed, told = self._refine(start, np.append(found, 0.0))
            sigma = float(np.sqrt(told.covariance[_NUM_POSES, _NUM_POSES]))
            if sigma <= MAX_CLOCK_SIGMA:
                found, weighed, clock_sigma = timed, told, sigma
        misfits = self._misfits(start, found)
        offset = float(found[_NUM_POSES:].sum())
        return HandEyeFit(
            photos=self.photos,
            vehicles=tuple(photo.logged(self.log, offset) for photo in self.photos),
            poses=(move(start[0], found[:6]), move(start[1], found[6:12])),
            middle=self.board.points().mean(axis=0),
            residuals=tuple(-misfits.reshape(len(self.photos), -1, 2)),
            mount_covariance=weighed.covariance[:6, :6],
            response=weighed.response[:6],
            clock_offset=offset,
            clock_sigma=clock_sigma,
        )

    def misfits_of(self, fit: HandEyeFit) -> Scalars:
        """Give corner as projected minus corner as found with the poses and clock of a fit [px]."""
        return self._misfits(fit.poses, np.append(np.zeros(_NUM_POSES), fit.clock_offset))

    def _approach(self, start: tuple[Pose, Pose]) -> Step:
        """Give the step from the start with all corners alike: near enough to weigh them."""

        def misfits(x: Step) -> Scalars:
            return self._misfits(start, x)

        def derive(x: Step) -> Jacobian:
            return self._derive(start, x)

        nothing = np.zeros(_NUM_POSES)
        return least_squares(misfits, nothing, jac=derive, x_scale="jac", method="lm").x

    def _refine(self, start: tuple[Pose, Pose], step: Step) -> tuple[Step, Weighed]:
        """Give the best step with photos weighed by their noise, which is told anew each time."""
        for _ in range(_NUM_ROUNDS):
            weighed = self._weigh(start, step)
            step = step - weighed.response @ self._misfits(start, step)
        return step, self._weigh(start, step)

    def _weigh(self, start: tuple[Pose, Pose], step: Step) -> Weighed:
        jacobian, misfits = self._derive(start, step), self._misfits(start, step)
        return weigh_photos(jacobian, misfits, len(self.photos))

    def _misfits(self, start: tuple[Pose, Pose], step: Step) -> Scalars:
        """Give corner as projected minus corner as found, all photos one after another [px]."""
        mount, world_from_board = move(start[0], step[:6]), move(start[1], step[6:12])
        times = np.array([photo.time for photo in self.photos]) + step[_NUM_POSES:].sum()
        positions, rotations = self.log.at(times)
        in_world = world_from_board @ self.board.points()
        away = in_world[None] - positions[:, None]
        in_vehicle = np.einsum("fji,fnj->fni", rotations.as_matrix(), away)
        in_camera = (in_vehicle - mount.translation) @ mount.rotation
        seen = project(self.camera, in_camera.reshape(-1, 3), self.index)
        found = np.concatenate([photo.view.corners for photo in self.photos])
        return np.ravel(np.nan_to_num(seen - found, nan=_UNSEEN))

    def _derive(self, start: tuple[Pose, Pose], step: Step) -> Jacobian:
        """Give the derivatives of the misfits, by central differences."""
        sizes = np.full(len(step), _SMALL)
        # Over less than the log's own interval its noise would be taken for speed.
        sizes[_NUM_POSES:] = min(self.log.interval, MAX_CLOCK_SIGMA)
        changes = np.diag(sizes)
        return np.stack(
            [
                (self._misfits(start, step + change) - self._misfits(start, step - change))
                / (2 * size)
                for change, size in zip(changes, sizes, strict=True)
            ],
            axis=1,
        )
