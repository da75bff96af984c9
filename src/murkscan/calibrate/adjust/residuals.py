"""Residuals of an adjustment and their derivatives by its parameters and the boards' poses.

Three blocks of rows, one after another: two a corner [px], one a stripe point [px], and where there
is a log, six a photo [m, rad]. What each depends on is known: a corner on its own board, a stripe
point on its board's plane, so that derivatives by the poses follow from those by a point, whatever
the number of boards. Derivatives by the few parameters are central differences of the very
functions that measure later, so that no port or sheet needs its own.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from ...optics import perturb_rig
from ...types.arrays import Indices, Scalars
from ...types.rig import Rig
from ...types.rig_covariance import unit_of
from .log import CLOCK, LoggedPoses, Stand
from .observations import Boards, Observed, distances_along_rays, index_of, pixels_by_points

_STEPS = {"px": 1e-2, "m": 1e-5, "rad": 1e-5, "": 1e-5}
"""Change of a parameter over which its derivative is taken; errors go with its square."""
_POSE_STEP = 1e-6
"""Turn [rad] and shift [m] of a board over which what a log says of it is differentiated."""

Rows = Float[np.ndarray, "..."]
"""One number a residual."""


@dataclass(frozen=True, eq=False)
class Observations:
    """Everything that was observed."""

    seen: Observed
    """Corners and stripe points."""
    logged: LoggedPoses | None = None
    """What a log says of the vehicle; None where none was kept."""


@dataclass(frozen=True, eq=False)
class State:
    """Where an adjustment is: what differs from its start, and where the boards are."""

    start: Rig
    names: tuple[str, ...]
    changes: Scalars
    """What has been added to each of the names."""
    boards: Boards
    stand: Stand | None = None
    """Where the board stands in the world at the start; None without a log."""

    @property
    def rig(self) -> Rig:
        """The rig as it is now."""
        places = [i for i, name in enumerate(self.names) if not is_of_stand(name)]
        return perturb_rig(self.start, [self.names[i] for i in places], self.changes[places])

    @property
    def stand_now(self) -> Stand | None:
        """Where the board stands as it is now."""
        if self.stand is None:
            return None
        return self.stand.perturb(dict(zip(self.names, self.changes.tolist(), strict=True)))

    def move(self, changes: Scalars, steps: Float[np.ndarray, "p 6"]) -> "State":
        """Change the parameters, and move the boards."""
        boards = self.boards.move(steps)
        return State(self.start, self.names, self.changes + changes, boards, self.stand)

    def rebase(self, names: Sequence[str]) -> "State":
        """Count changes from the state as it is now, of perhaps other parameters."""
        return State(self.rig, tuple(names), np.zeros(len(names)), self.boards, self.stand_now)


def is_of_stand(name: str) -> bool:
    """Tell whether a parameter is one of where the board stands or of the clock, not of the rig."""
    return name == CLOCK or name.startswith("stand.")


@dataclass(frozen=True, eq=False)
class Linearised:
    """Residuals, corners first, then stripe points, then the log; and what they change with."""

    names: tuple[str, ...]
    """The parameters that they are differentiated by."""
    residuals: Rows
    by_rig: Float[np.ndarray, "r k"]
    by_pose: Float[np.ndarray, "r 6"]
    """By the turn [rad] and the shift [m] of the row's own board."""
    photo: Indices
    """Number of each row's photo."""
    num_corner_rows: int
    """Rows of corners: two each."""
    num_log_rows: int
    """Rows of the log: six a photo, or none."""


def residuals_of(state: State, observed: Observations, scale: Scalars) -> Rows:
    """Compute all residuals; `scale` [m/px] makes pixels of stripe points' distances."""
    rig, seen = state.rig, observed.seen
    corners = seen.corner_residuals(rig.camera, seen.place_corners(state.boards), index_of(rig))
    distances = seen.stripe_distances(rig, state.boards, seen.stripe)
    logged = _logged_residuals(state, observed.logged)
    return np.concatenate([corners.ravel(), distances / scale, logged])


def _logged_residuals(state: State, logged: LoggedPoses | None) -> Rows:
    mount, stand = state.rig.vehicle_from_camera, state.stand_now
    if logged is None or mount is None or stand is None:
        return np.zeros(0)
    return logged.residuals(mount, stand, state.boards).ravel()


def linearise(state: State, observed: Observations, scale: Scalars) -> Linearised:
    """Compute the residuals and their derivatives."""
    seen, residuals = observed.seen, residuals_of(state, observed, scale)
    by_rig = np.zeros((len(residuals), len(state.names)))
    num_photos = len(state.boards.translations)
    nobody = np.zeros((num_photos, 6))
    for column, name in enumerate(state.names):
        step = np.zeros(len(state.names))
        step[column] = _step_of(name, observed)
        ahead = residuals_of(state.move(step, nobody), observed, scale)
        behind = residuals_of(state.move(-step, nobody), observed, scale)
        by_rig[:, column] = (ahead - behind) / (2 * step[column])
    stripes = _stripes_by_pose(state, seen) / scale[:, None]
    logged = _logged_by_pose(state, observed.logged)
    of_log = np.repeat(np.arange(num_photos), 6)[: len(logged)]
    return Linearised(
        names=state.names,
        residuals=residuals,
        by_rig=by_rig,
        by_pose=np.concatenate([_corners_by_pose(state, seen), stripes, logged]),
        photo=np.concatenate([np.repeat(seen.corner_photo, 2), seen.stripe_photo, of_log]),
        num_corner_rows=2 * len(seen.corners),
        num_log_rows=len(logged),
    )


def _step_of(name: str, observed: Observations) -> float:
    if name == CLOCK and observed.logged is not None:
        return observed.logged.log.clock_step
    return _STEPS[unit_of(name)]


def _logged_by_pose(state: State, logged: LoggedPoses | None) -> Float[np.ndarray, "_ 6"]:
    if logged is None:
        return np.zeros((0, 6))
    num_photos, slopes = len(state.boards.translations), []
    still = np.zeros(len(state.names))
    for axis in np.eye(6) * _POSE_STEP:
        steps = np.tile(axis, (num_photos, 1))
        ahead = _logged_residuals(state.move(still, steps), logged)
        behind = _logged_residuals(state.move(still, -steps), logged)
        slopes.append((ahead - behind) / (2 * _POSE_STEP))
    return np.stack(slopes, axis=1)


def _corners_by_pose(state: State, observed: Observed) -> Float[np.ndarray, "_ 6"]:
    rig, boards = state.rig, state.boards
    points = observed.place_corners(boards)
    slopes = pixels_by_points(rig.camera, points, index_of(rig)).reshape(-1, 3)
    arms = np.repeat(points - boards.centres[observed.corner_photo], 2, axis=0)
    # Moving a point by ω × arm + τ changes u by slope · (ω × arm + τ).
    return np.concatenate([np.cross(arms, slopes), slopes], axis=1)


def _stripes_by_pose(state: State, observed: Observed) -> Float[np.ndarray, "_ 6"]:
    """Differentiate the distances from the sheet [m]; only the board's plane matters to them."""
    rig, boards = state.rig, state.boards
    points, directions = observed.place_stripes(rig, boards, observed.stripe)
    normals = boards.rotations[observed.stripe_photo, :, 2]
    along = distances_along_rays(observed, rig, points, directions)
    along = along / np.sum(normals * directions, axis=1)
    slopes = along[:, None] * normals
    arms = points - boards.centres[observed.stripe_photo]
    return np.concatenate([np.cross(arms, slopes), slopes], axis=1)
